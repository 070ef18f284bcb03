#pragma once

#include <cstddef>
#include <span>

#include "interflect/elements/forest.h"
#include "interflect/path_tracer.h"
#include "interflect/render/path_wavefront.h"

namespace interflect::inline detail {

/// Irradiance of every element, at which final gathering ends its paths.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;
};
/// @throws InputError for sizes that disagree and a forest of another scene.
KnownIrradiance known_irradiance(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);

/// Peak memory of trace_picture(), including its result [bytes]. Measured with pictures of 2048 x 2048 pixels and with
/// a sphere of 1.4 million emitting patches.
inline constexpr std::size_t path_bytes_per_pixel = 600, path_bytes_per_patch = 250;

/// Traces the paths of a picture, in rounds where there is a target: what trace_paths(), gather() and
/// measure_illuminance() have in common.
/// @param start  Of options.width x options.height pixels.
/// @param known  Null: paths go on until roulette ends them.
PathTracing trace_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                          const PathOptions& options, const PathMonitor& monitor, const KnownIrradiance* known);

/// Paths through the pixels of a view. @throws InputError as Camera() does.
PathStart start_at_camera(const View& view, const PathOptions& options, const Imath::V3d& origin);

}  // namespace interflect::inline detail
