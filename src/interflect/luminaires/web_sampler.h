#pragma once

#include <vector>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Samples directions by the intensity of a photometric web, exactly as interpolated. Immutable, shared by all threads.
class WebSampler {
  public:
    /// @param web  Must not have a web_fault().
    explicit WebSampler(const PhotometricWeb& web);

    double flux() const { return azimuth_flux_.back(); }  ///< [lm or W]
    /// Returns a unit direction in the luminaire's frame for u (azimuth) and v (polar angle) uniform in (0, 1). Equal
    /// areas of (u, v) have equal flux.
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
    /// Cumulative flux per radian of azimuth, for each azimuth up to each polar angle.
    std::vector<double> cumulative_;
    std::vector<double> azimuth_flux_;  // cumulative, up to each azimuth
};

}  // namespace interflect::detail
