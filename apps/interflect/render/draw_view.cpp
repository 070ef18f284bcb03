#include "apps/interflect/render/draw_view.h"

#include <spdlog/spdlog.h>

#include <functional>
#include <utility>

#include "apps/interflect/drawing/drawing_progress.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/drawing/show.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/render/previews.h"
#include "interflect/image.h"
#include "interflect/render.h"

namespace interflect::command {

namespace {

Picture draw_quantity_of_elements(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                                  const PictureOptions& picture_options, const RenderArguments& options) {
    DrawingProgress progress;
    QuantityPicture drawn = show_quantity(options.shown, solved, ray_caster, view, picture_options, progress.monitor());
    return picture_of_quantity(std::move(drawn), options);
}

/// Draws flat or smooth shading, with the mesh for --show mesh.
Picture draw_elements(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                      const PictureOptions& picture_options, const RenderArguments& options) {
    DrawingProgress progress;
    const Rendering drawn =
        interflect::render(solved.scene, solved.solution, ray_caster, view, picture_options, progress.monitor());
    Picture picture = picture_of_light(drawn.image, drawn.non_finite_pixels, options);
    if (options.shown == Shown::mesh)
        picture.image = draw_mesh(picture.image, solved.scene, solved.solution, ray_caster, view,
                                  picture_options.samples, picture_options.seed, progress.monitor());
    return picture;
}

/// Draws a preview as the final picture.
Picture draw_rough_picture(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                           const PictureOptions& picture_options, double reduction, const RenderArguments& options) {
    DrawingProgress progress;
    const Rendering drawn = draw_preview(solved.scene, solved.solution, ray_caster, view, picture_options, reduction,
                                         options.path.denoise, progress.monitor());
    return picture_of_light(drawn.image, drawn.non_finite_pixels, options);
}

}  // namespace

Picture draw_paths(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, const View& view,
                   const PictureOptions& picture_options, const RenderArguments& options) {
    std::function<void(const Image&)> on_picture;
    if (options.progressive)
        on_picture = [&](const Image& so_far) {
            write_interim_picture(picture_of_light(so_far, count_non_finite(so_far), options), view, scene, options);
        };
    TracedPicture traced =
        run_path_tracer(scene, solution, ray_caster, view, picture_options, options.path, on_picture);
    Picture picture = picture_of_light(traced.image, traced.non_finite_pixels, options);
    picture.traced = std::move(traced);
    return picture;
}

Picture draw_solution(const SolvedScene& solved, const RayCaster& ray_caster, const View& view, const DrawingPlan& plan,
                      const RenderArguments& options) {
    const PictureOptions& picture_options = plan.picture;
    if (is_quantity(options.shown))
        return draw_quantity_of_elements(solved, ray_caster, view, picture_options, options);
    if (!traces_paths(picture_options.shading))
        return draw_elements(solved, ray_caster, view, picture_options, options);
    if (options.path.has_path_outputs())
        return draw_paths(solved.scene, &solved.solution, ray_caster, view, picture_options, options);
    if (plan.reduction() > 1)
        return draw_rough_picture(solved, ray_caster, view, picture_options, plan.reduction(), options);
    if (!is_stop_requested()) {  // a signal would end path tracing before its first ray
        Picture picture = draw_paths(solved.scene, &solved.solution, ray_caster, view, picture_options, options);
        if (has_every_pixel(picture.traced)) return picture;
    }
    spdlog::warn("stopped before each pixel had enough light: the picture is a rough one");
    return draw_rough_picture(solved, ray_caster, view, picture_options, usual_reduction, options);
}

}  // namespace interflect::command
