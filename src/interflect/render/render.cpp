#include "interflect/render.h"

#include <fmt/format.h>

#include "interflect/core.h"
#include "interflect/render/pictures/element_picture.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/render_elements.h"

namespace interflect {

using namespace detail;

namespace {

PictureOptions with_samples(PictureOptions options) {
    options.samples = require_samples(options.shading, &DefaultSamples::pixel, options.samples);
    return options;
}

Rendering draw(const Scene& scene, KnownIrradiance known, const RayCaster& ray_caster, const View& view,
               const PictureOptions& options, const Monitor& monitor) {
    if (!needs_solution(options.shading)) return render(scene, ray_caster, view, options, monitor);
    const PictureOptions complete = with_samples(options);
    if (!traces_paths(complete.shading))
        return draw_elements(scene, known.forest, ray_caster, view, known.irradiance, complete, monitor);
    known.is_interpolated = complete.shading == Shading::hybrid;
    return trace_picture(scene, ray_caster, start_at_camera(view, complete, scene.origin), complete, monitor, &known);
}

}  // namespace

Rendering detail::render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                         std::span<const Rgb> irradiance, const PictureOptions& options, const Monitor& monitor) {
    return draw(scene, known_irradiance(scene, forest, irradiance), ray_caster, view, options, monitor);
}

Rendering render(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                 const PictureOptions& options, const Monitor& monitor) {
    return draw(scene, known_irradiance(scene, solution), ray_caster, view, options, monitor);
}

Rendering render(const Scene& scene, const RayCaster& ray_caster, const View& view, const PictureOptions& options,
                 const Monitor& monitor) {
    if (needs_solution(options.shading))
        throw InputError(fmt::format("{} shading needs a solution", label(options.shading)));
    const PictureOptions complete = with_samples(options);
    const PathStart start = start_at_camera(view, complete, scene.origin);
    if (complete.shading == Shading::instant) return trace_instant_picture(scene, ray_caster, start, complete, monitor);
    return trace_picture(scene, ray_caster, start, complete, monitor, nullptr);
}

}  // namespace interflect
