#pragma once

#include <filesystem>

#include "apps/interflect/render/render_arguments.h"
#include "interflect/core.h"
#include "interflect/preview.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// PreviewOptions::reduction of previews, unless time is short or a finer preview has time.
inline constexpr int usual_reduction = 4;

/// Whether a later picture can replace `output`, which pipes and devices do not permit.
bool is_replaceable(const std::filesystem::path& output);

/// Returns `picture` with smooth shading and few samples, for pictures in about a second.
PictureOptions quick_options(PictureOptions picture);

/// Draws the light in about a second: by preview() for hybrid shading, else by quick_options().
/// @param reduction  PreviewOptions::reduction; without effect on other shadings than hybrid.
/// @param denoiser   Of hybrid shading; automatic if empty.
Rendering draw_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                       const PictureOptions& picture, int reduction, std::optional<Denoiser> denoiser,
                       const Monitor& monitor);

/// Draws a preview of the light and writes it to the output, if previews are wanted. They are with --progressive;
/// without it, for pictures of light in .png and .jpg files that take more than about a second and have no time limit.
void write_preview_of(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                      const RenderArguments& options, int reduction);

}  // namespace interflect::command
