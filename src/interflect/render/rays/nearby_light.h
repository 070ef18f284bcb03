#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

/// Predicts the light of a surface in a pixel from samples of the pixels around it. Immutable, thread-safe.
///
/// The prediction for a pixel is linear in the light of the samples and does not use the pixel's own. So it is unbiased
/// as a control variate.
class NearbyLight {
  public:
    /// First sample of a half of a pixel's samples.
    struct Sample {
        V3f position{0, 0, 0}, normal{0, 0, 0};
        /// Distance between the points of adjacent pixels [m]; 0 if the sample shows no reflecting surface.
        float spacing = 0;
        Rgb reflectance{0, 0, 0};
        Rgb reflected{0, 0, 0};  ///< Reflected radiance.
    };
    /// @param samples  Two of each pixel, row by row.
    NearbyLight(int width, int height, std::vector<Sample> samples)
        : width_(width), height_(height), samples_(std::move(samples)) {}

    struct Found {
        Rgb light{0, 0, 0};  ///< Reflected radiance over reflectance, mean of the samples.
        float weight = 0;    ///< Their weight: up to 0.6 for each sample, 12 if all show the plane.
    };
    /// Returns the light of samples around the pixel that show the plane of the patch.
    Found at(std::uint32_t pixel, const PatchGeometry& patch) const;

  private:
    int width_, height_;
    std::vector<Sample> samples_;
};

/// Light of the patches in one pixel, for lookups by one thread: consecutive lookups are in the same pixel.
class NearbyLightLookups {
  public:
    void clear() { lights_.clear(); }
    const NearbyLight::Found& find(const NearbyLight& light, std::uint32_t pixel, PatchIndex patch,
                                   const PatchGeometry& geometry);

  private:
    std::uint32_t pixel_ = 0;  // of all lights
    std::vector<std::pair<PatchIndex, NearbyLight::Found>> lights_;
};

}  // namespace interflect::detail
