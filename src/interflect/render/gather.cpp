#include "interflect/render/pictures/render_elements.h"

#include "interflect/render/pictures/path_picture.h"

namespace interflect {

using namespace detail;

PathTracing detail::gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                           const View& view, std::span<const Rgb> irradiance, const PathOptions& options,
                           const Monitor& monitor) {
    const KnownIrradiance known = known_irradiance(scene, forest, irradiance);
    return trace_picture(scene, ray_caster, start_at_camera(view, options, scene.origin), options, monitor, &known);
}

PathTracing gather(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const PathOptions& options, const Monitor& monitor) {
    return detail::gather(scene, *solution.forest, ray_caster, view, solution.irradiance, options, monitor);
}

PathTracing render_hybrid(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                          const PathOptions& options, const Monitor& monitor) {
    KnownIrradiance known = known_irradiance(scene, *solution.forest, solution.irradiance);
    known.is_interpolated = true;
    return trace_picture(scene, ray_caster, start_at_camera(view, options, scene.origin), options, monitor, &known);
}

}  // namespace interflect
