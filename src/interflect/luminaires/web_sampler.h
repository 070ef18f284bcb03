#pragma once

#include <vector>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Samples directions exactly by a web's interpolated intensity.
class WebSampler {
  public:
    /// @param web  Without web_fault().
    explicit WebSampler(const PhotometricWeb& web);

    double flux() const { return azimuth_flux_.back(); }  ///< [lm or W]
    /// Returns a unit direction in the luminaire's frame. Equal areas of (u, v) have equal flux.
    /// @param u, v  In (0, 1), for azimuth and polar angle.
    V3f direction(float u, float v) const;

  private:
    struct Azimuth {
        std::size_t index;
        double share;
    };
    Azimuth azimuth_at(double flux) const;
    double polar_at(const Azimuth& azimuth, float v) const;

    PhotometricWeb::Pole pole_;
    std::vector<double> polar_, azimuth_;  // [radians]
    std::vector<float> intensities_;
    /// Flux per radian of each azimuth, cumulative over polar angles.
    std::vector<double> cumulative_;
    std::vector<double> azimuth_flux_;  // cumulative
};

}  // namespace interflect::detail
