#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/camera.h"
#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// The camera rays of a picture.
struct CameraSampling {
    int width = 1, height = 1;  ///< [pixels], as the camera has them.
    int samples = 16;           ///< A pixel, >= 1: a low-discrepancy sequence of each pixel's own.
    std::uint64_t seed = 1;     ///< Of these sequences.
};

/// A step on the picture from the place of a sample [pixels]: right and down.
struct PixelOffset {
    float x = 0, y = 0;
};

/// The rays of one pixel and what they hit: sample by sample, the offsets of a sample side by side.
struct PixelSamples {
    std::size_t pixel = 0;  ///< y * width + x.
    std::span<const Ray> rays;
    std::span<const Hit> hits;
};

/// Traces a camera ray at each of `offsets` from every sample, and calls `visit` for one pixel after the other, from
/// any thread and in any order. The same rays for the same seed and any number of threads.
/// @throws InputError for less than one sample or one pixel.
void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const CameraSampling& sampling,
                  std::span<const PixelOffset> offsets, const PictureMonitor& monitor,
                  const std::function<void(const PixelSamples&)>& visit);

/// The same with one ray at each sample.
inline void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const CameraSampling& sampling,
                         const PictureMonitor& monitor, const std::function<void(const PixelSamples&)>& visit) {
    constexpr PixelOffset none_at_all;
    trace_pixels(camera, ray_caster, sampling, {&none_at_all, 1}, monitor, visit);
}

/// Where on its patch a ray hit; hit.patch != none.
inline Parameters parameters_of_hit(const ElementForest& forest, const Ray& ray, const Hit& hit) {
    return forest.geometry(hit.patch).parameters_of(ray.origin + hit.distance * ray.direction);
}

/// The leaf that a ray hit; none where it escapes.
inline std::uint32_t leaf_of_hit(const ElementForest& forest, const Ray& ray, const Hit& hit) {
    if (hit.patch == none || forest.is_leaf(hit.patch)) return hit.patch;
    return forest.leaf_at(hit.patch, parameters_of_hit(forest, ray, hit));
}

/// @throws InputError unless there are as many values as elements. @param what  The values' name for the message.
void require_values_of_elements(const ElementForest& forest, std::size_t value_count, const char* what);

}  // namespace interflect::inline detail
