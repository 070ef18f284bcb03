#pragma once

#include <vector>

#include "interflect/luminaires/sky_radiance.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// What is seen of a scene's skies and suns where nothing is in the way, and directions in which it is bright.
/// Immutable, shared by all threads.
class Skies {
  public:
    explicit Skies(const Scene& scene);

    /// Radiance of the skies, suns left out [cd/m^2 or W/(m^2 sr)]. @param direction  Of unit length.
    Rgb radiance(const V3f& direction) const;
    /// With the discs of suns.
    Rgb seen(const V3f& direction) const;

    /// Whether a sky is there that is worth being sampled: one that is not uniform.
    bool can_sample() const { return !sampled_.empty(); }
    struct Sample {
        V3f direction{0, 0, 1};
        float density = 0;  ///< Per solid angle, over all skies that are sampled [1/sr].
    };
    /// A direction in proportion to the radiance of those skies. @param sky  Chooses one; all uniform in (0, 1).
    Sample sample(double sky, float u, float v) const;
    float density(const V3f& direction) const;
    /// Radiance of those skies.
    Rgb sampled_radiance(const V3f& direction) const;
    Rgb uniform_radiance() const { return uniform_; }  ///< Of the others.

  private:
    struct Sampled {
        SkyRadiance radiance;
        DirectionTable table;
        double share;  // of the samples, up to this one
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

}  // namespace interflect::inline detail
