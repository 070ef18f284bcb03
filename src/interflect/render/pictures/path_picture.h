#pragma once

#include <cstddef>
#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"
#include "interflect/render/prepared/prepared_light.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Return the irradiance as known light. @throws InputError for inconsistent sizes or a forest of another scene.
KnownIrradiance known_irradiance(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance);
KnownIrradiance known_irradiance(const Scene& scene, const Solution& solution);

/// Peak memory of trace_picture() [bytes].
inline constexpr std::size_t path_bytes_per_pixel = 880;

/// Draws the picture with virtual lights; the arguments are those of trace_picture().
Rendering trace_instant_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                                const PictureOptions& options, const Monitor& monitor);

/// Draws a picture by path tracing, final gathering or hybrid shading. Collective.
/// @param start                Camera or gauges of options.width x options.height pixels.
/// @param known                Light at which paths end; null: only Russian roulette ends them.
/// @param has_direct_sunlight  Whether the picture shows light that directional lights send to its surfaces.
/// @return                     The picture in rank 0; empty in other ranks.
Rendering trace_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                        const PictureOptions& options, const Monitor& monitor, const KnownIrradiance* known,
                        bool has_direct_sunlight = true);

/// Returns the start of paths at the camera of a view. @throws InputError as Camera() does.
PathStart start_at_camera(const View& view, const PictureOptions& options, const Imath::V3d& origin);

}  // namespace interflect::detail
