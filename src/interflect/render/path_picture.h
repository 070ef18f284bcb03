#pragma once

#include <cstddef>
#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"
#include "interflect/render/path_wavefront.h"

namespace interflect::detail {

/// Irradiance of every element, with which final gathering ends its paths.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;
};
/// @throws InputError if the sizes disagree or the forest belongs to another scene.
KnownIrradiance known_irradiance(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);

/// Peak memory of trace_picture() with its result [bytes], measured with 2048 x 2048 pixels and with a sphere of 1.4
/// million emitting patches.
inline constexpr std::size_t path_bytes_per_pixel = 600, path_bytes_per_patch = 250;

/// Traces a picture for trace_paths(), gather() and measure_irradiance(), in rounds if it has an error target.
/// @param start  Starts of options.width x options.height pixels.
/// @param known  Null: paths end by Russian roulette.
PathTracing trace_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                          const PathOptions& options, const Monitor& monitor, const KnownIrradiance* known);

/// Starts paths through the pixels of a view. @throws InputError as Camera() does.
PathStart start_at_camera(const View& view, const PathOptions& options, const Imath::V3d& origin);

}  // namespace interflect::detail
