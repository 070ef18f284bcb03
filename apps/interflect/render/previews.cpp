#include "apps/interflect/render/previews.h"

#include <algorithm>
#include <cstddef>
#include <system_error>

#include "apps/interflect/processes/signals.h"
#include "apps/interflect/render/pictures.h"

namespace interflect::command {

namespace {

bool takes_previews(const RenderArguments& options) {
    constexpr std::size_t fewest_pixels = 1 << 16;  // drawing fewer takes less than a second
    if (options.progressive) return true;
    return !options.has_time_limit() && options.is_for_display() && options.shown == Shown::light &&
           options.size.pixels() >= fewest_pixels && is_replaceable(options.output);
}

}  // namespace

bool is_replaceable(const std::filesystem::path& output) {
    std::error_code ignored;
    const auto status = std::filesystem::status(output, ignored);
    return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

PictureOptions quick_options(PictureOptions picture) {
    constexpr int most_samples = 4;  // only edges need several camera rays in smooth shading
    picture.shading = Shading::smooth;
    picture.samples = std::min(picture.samples, most_samples);
    return picture;
}

Rendering draw_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                       const PictureOptions& picture, double reduction, std::optional<Denoiser> denoiser,
                       const Monitor& monitor) {
    if (picture.shading == Shading::hybrid)
        return preview(scene, solution, ray_caster, view, picture, {reduction, denoiser.value_or(Denoiser::automatic)},
                       monitor);
    return interflect::render(scene, solution, ray_caster, view, quick_options(picture), monitor);
}

void write_preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const RenderArguments& options, double reduction) {
    if (!takes_previews(options)) return;
    const Rendering drawn = draw_preview(scene, solution, ray_caster, view, options.picture, reduction,
                                         options.path.denoise, {{}, &stop_flag()});
    if (drawn.interrupted) return;
    write_interim_picture(picture_of_light(drawn.image, drawn.non_finite_pixels, options), view, scene, options);
}

}  // namespace interflect::command
