#include "interflect/render.h"

#include "interflect/render/pictures/path_picture.h"

namespace interflect {

using namespace detail;

PathTracing trace_paths(const Scene& scene, const RayCaster& ray_caster, const View& view, const PathOptions& options,
                        const Monitor& monitor) {
    return trace_picture(scene, ray_caster, start_at_camera(view, options, scene.origin), options, monitor, nullptr);
}

PathTracing render_instant(const Scene& scene, const RayCaster& ray_caster, const View& view,
                           const PathOptions& options, const Monitor& monitor) {
    return trace_instant_picture(scene, ray_caster, start_at_camera(view, options, scene.origin), options, monitor);
}

}  // namespace interflect
