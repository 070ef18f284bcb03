#pragma once

#include <filesystem>
#include <optional>

#include "apps/interflect/render/render_arguments.h"
#include "interflect/core.h"
#include "interflect/denoise.h"
#include "interflect/preview.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// PreviewOptions::reduction, unless --time requires another or --progressive draws the finished light.
inline constexpr double usual_reduction = 4;

/// Whether a later picture can replace `output`, which pipes and devices do not permit.
bool is_replaceable(const std::filesystem::path& output);

/// Returns options of smooth shading with few samples, for a picture in about a second.
PictureOptions quick_options(PictureOptions picture);

/// Draws the light in about a second: hybrid shading by preview(), other shadings with quick_options().
/// @param reduction  PreviewOptions::reduction of hybrid shading.
/// @param denoiser   Filter of hybrid shading; automatic if empty.
Rendering draw_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                       const PictureOptions& picture, double reduction, std::optional<Denoiser> denoiser,
                       const Monitor& monitor);

/// Draws a preview of the light and writes it to the output, where a better picture will replace it. Has no effect
/// unless previews are wanted: always with --progressive, otherwise for large pictures of light without a time limit in
/// .png and .jpg files.
void write_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const RenderArguments& options, double reduction);

}  // namespace interflect::command
