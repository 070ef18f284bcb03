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

namespace interflect::detail {

struct CameraSampling {
    int width = 1, height = 1;  ///< [pixels]
    int samples = 16;           ///< Number of samples per pixel, >= 1.
    std::uint64_t seed = 1;
};

/// Offset to the right and down [pixels].
struct PixelOffset {
    float x = 0, y = 0;
};

/// Rays and hits of a pixel, ordered by sample.
struct PixelSamples {
    std::size_t pixel = 0;  ///< y * width + x.
    std::span<const Ray> rays;
    std::span<const Hit> hits;
};

/// Traces one ray per sample and offset. Calls `visit` once per pixel, from any thread, in any order.
/// @throws InputError for less than one sample or pixel.
void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const CameraSampling& sampling,
                  std::span<const PixelOffset> offsets, const Monitor& monitor,
                  const std::function<void(const PixelSamples&)>& visit);

inline void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const CameraSampling& sampling,
                         const Monitor& monitor, const std::function<void(const PixelSamples&)>& visit) {
    constexpr PixelOffset no_offset;
    trace_pixels(camera, ray_caster, sampling, {&no_offset, 1}, monitor, visit);
}

/// Returns the parameters of the hit. The ray must hit a patch.
inline Parameters parameters_of_hit(const ElementForest& forest, const Ray& ray, const Hit& hit) {
    return forest.geometry(hit.patch).parameters_of(ray.origin + hit.distance * ray.direction);
}

/// Returns the leaf that the ray hit; `none` if the ray escaped.
inline ElementIndex leaf_of_hit(const ElementForest& forest, const Ray& ray, const Hit& hit) {
    if (hit.patch == none || forest.is_leaf(hit.patch)) return hit.patch;
    return forest.leaf_at(hit.patch, parameters_of_hit(forest, ray, hit));
}

/// @throws InputError naming `what` unless each element has a value.
void require_values_of_elements(const ElementForest& forest, std::size_t value_count, const char* what);

}  // namespace interflect::detail
