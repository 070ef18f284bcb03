#pragma once

#include <vector>

#include "interflect/luminaires/skies/sky_radiance.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Unoccluded radiance of skies and suns.
class Skies {
  public:
    explicit Skies(const Scene& scene);

    /// Returns the radiance without suns [cd/m^2 or W/(m^2 sr)]. @param direction  Unit length.
    Rgb radiance(const V3f& direction) const;
    /// Returns the radiance with the discs of suns.
    Rgb radiance_with_suns(const V3f& direction) const;

    bool can_sample() const { return !sampled_.empty(); }
    struct Sample {
        V3f direction{0, 0, 1};
        float density = 0;  ///< Over all sampled skies [1/sr].
    };
    /// Samples non-uniform skies by radiance.
    /// @param sky  Selects the sky; all arguments in (0, 1).
    Sample sample(double sky, float u, float v) const;
    float density(const V3f& direction) const;
    Rgb sampled_radiance(const V3f& direction) const;
    Rgb uniform_radiance() const { return uniform_; }

  private:
    struct Sampled {
        SkyRadiance radiance;
        DirectionTable table;
        double share;  // cumulative
    };
    struct Disc {
        V3f towards;
        float sine;
        Rgb radiance;
    };
    Rgb uniform_{0, 0, 0};
    std::vector<Sampled> sampled_;
    std::vector<Disc> discs_;
};

}  // namespace interflect::detail
