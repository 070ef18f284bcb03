#include "apps/interflect/drawing/view_check.h"

#include <spdlog/spdlog.h>

#include "apps/interflect/values/percent.h"
#include "interflect/prepare.h"

namespace interflect::command {

namespace {

constexpr double all_rays = 1;  // as a share of the rays of a picture

}  // namespace

void warn_of_camera_outside(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect) {
    const ViewCoverage seen = view_coverage(scene, ray_caster, view, aspect);
    // The surroundings of plans and sections are empty, and their cut walls show backs.
    const bool is_orthographic = view.extent > 0;
    if (is_orthographic) {
        if (seen.nothing == all_rays) spdlog::warn("{}: the whole scene lies in front of the cut", view.name);
        return;
    }
    constexpr double half_of_rays = 0.5;
    if (seen.nothing + seen.backs <= half_of_rays) return;
    spdlog::warn(
        "view '{}': the camera seems to be outside the scene: {} of the picture is empty and {} is seen through "
        "the backs of one-sided faces",
        view.name, percent(seen.nothing), percent(seen.backs));
}

void warn_of_darkness(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect) {
    const char* reason = "all that it sees is unlit; is the camera inside a closed object?";
    if (!emits_light(scene))
        reason = "the scene emits no light";
    else if (view_coverage(scene, ray_caster, view, aspect).nothing == all_rays)
        reason = "it meets no surface";
    spdlog::warn("the view shows no light: {}", reason);
}

}  // namespace interflect::command
