#include "interflect/gather.h"

#include "interflect/render/camera_samples.h"
#include "interflect/render/path_picture.h"

namespace interflect {

PathTracing gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                   std::span<const Rgb> irradiance, const PathOptions& options, const PathMonitor& monitor) {
    forest.require_made_for(scene);
    require_values_of_elements(forest, irradiance.size(), "irradiance");
    const KnownIrradiance known{forest, irradiance};
    return trace_picture(scene, ray_caster, view, options, monitor, &known);
}

PathTracing gather(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const PathOptions& options, const PathMonitor& monitor) {
    return gather(scene, *solution.forest, ray_caster, view, solution.irradiance, options, monitor);
}

}  // namespace interflect
