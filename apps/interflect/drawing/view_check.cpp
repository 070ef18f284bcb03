#include "apps/interflect/drawing/view_check.h"

#include <spdlog/spdlog.h>

#include "apps/interflect/values/percent.h"
#include "interflect/prepare.h"

namespace interflect::command {

namespace {

constexpr double all = 1;  // share of the rays of a picture

}  // namespace

void warn_of_camera_outside(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect) {
    const ViewCoverage met = view_coverage(scene, ray_caster, view, aspect);
    if (view.extent > 0) {  // because plans may have empty surroundings, and cut walls show backs
        if (met.nothing == all) spdlog::warn("{}: the whole scene lies in front of the cut", view.name);
        return;
    }
    if (met.nothing + met.backs <= 0.5) return;
    spdlog::warn(
        "view '{}': the camera seems to be outside the scene: {} of the picture is empty and {} is seen through "
        "the backs of one-sided faces",
        view.name, percent(met.nothing), percent(met.backs));
}

void warn_of_darkness(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect) {
    const char* reason = "all that it sees is unlit; is the camera inside a closed object?";
    if (!emits_light(scene))
        reason = "the scene emits no light";
    else if (view_coverage(scene, ray_caster, view, aspect).nothing == all)
        reason = "it meets no surface";
    spdlog::warn("the view shows no light: {}", reason);
}

}  // namespace interflect::command
