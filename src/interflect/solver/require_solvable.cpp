#include "interflect/solver/require_solvable.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "interflect/core.h"

namespace interflect::detail {

void require_solvable(const Scene& scene, const SolveOptions& o) {
    std::vector<Fault> faults = scene_faults(scene);
    const auto require = [&](bool holds, const char* setting, const std::string& expected) {
        if (!holds) faults.push_back({fmt::format("{}: {}", setting, expected), "", setting});
    };
    if (scene.patches.empty()) faults.push_back({"the scene has no patches"});
    require(o.limits.rays > 0, "rays", "expected more than 0");
    require(o.limits.time > 0, "time", "expected more than 0");
    require(o.limits.until >= 0 && o.limits.until < 1, "until", "expected a relative error from 0 to below 1");
    require(o.experimental.warm_up >= 0, "warm_up", "expected 0 or more");
    require(o.experimental.iterations >= 0, "iterations", "expected 0 or more");
    require(o.experimental.rays_per_iteration >= 0 && o.experimental.rays_per_iteration <= max_rays_per_iteration,
            "rays_per_iteration", "expected 0 to 100 thousand million");
    require(o.experimental.epsilon > 0, "epsilon", "expected more than 0");
    require(o.experimental.epsilon_decay >= 0 && o.experimental.epsilon_decay <= 1, "epsilon_decay", "expected 0 to 1");
    require(o.refinement.min_area >= 0, "min_area", "expected 0 or more");
    require(o.refinement.max_elements >= scene.patches.size() && o.refinement.max_elements < 0xfffffff0u,
            "max_elements",
            fmt::format("{}, expected at least the number of patches, {}, and less than 2^32 - 16",
                        o.refinement.max_elements, scene.patches.size()));
    require(o.experimental.alpha >= 0 && o.experimental.alpha <= 1, "alpha", "expected 0 to 1");
    require(o.experimental.beta >= 0 && o.experimental.beta <= 1, "beta", "expected 0 to 1");
    require(o.experimental.inherited_weight >= 0 && o.experimental.inherited_weight <= 1, "inherited_weight",
            "expected 0 to 1");
    require(o.importance.smoothing >= 0 && o.importance.smoothing <= 1, "importance_smoothing", "expected 0 to 1");
    require(o.importance.exponent >= 0 && o.importance.exponent <= 1, "importance_exponent", "expected 0 to 1");
    require(o.importance.camera_rays > 0 && o.importance.camera_rays <= max_camera_rays, "camera_rays",
            "expected 1 to 2^22");
    for (const WeightedView& v : o.views) {
        const auto add = [&](const char* text) {
            faults.push_back({fmt::format("view '{}': {}", v.view.name, text), v.view.name, "views"});
        };
        if (v.view.extent != 0) add("it is orthographic; expected perspective views");
        if (!(v.weight > 0 && std::isfinite(v.weight) && v.aspect > 0 && std::isfinite(v.aspect) && v.pixel_rows > 0))
            add("weight, aspect and pixel_rows: expected finite numbers above 0");
    }
    require(!o.method.no_importance || o.method.importance == ImportanceUse::off, "importance",
            fmt::format("{} cannot be steered by it, since {}", o.method.name,
                        o.method.no_importance ? o.method.no_importance : ""));
    require(o.refinement.criterion != RefinementCriterion::perceptual ||
                (o.method.follows_variance && o.method.importance == ImportanceUse::full && !o.views.empty() &&
                 !o.experimental.one_bounce),
            "refinement_criterion",
            fmt::format("perceptual is not for {} with these settings; expected ihsrr or ihwdrs "
                        "with a view, full importance and passes over all bounces",
                        o.method.name));
    require(o.method.takes_luminaires || scene.luminaires.empty(), "method",
            fmt::format("{} knows only surfaces that emit, and the scene has other lights; choose another method",
                        o.method.name));
    require(o.method.separates_groups || scene.light_groups.empty(), "method",
            fmt::format("{} keeps the light of all groups together; choose another method", o.method.name));
    require(!o.keep_direct || (o.method.separates_direct && !o.experimental.one_bounce), "keep_direct",
            fmt::format("{} knows no direct light; expected a method of passes: srr, isrr, hsrr, ihsrr",
                        o.experimental.one_bounce ? "one bounce per iteration" : o.method.name));
    require_no_faults(faults, "cannot solve", scene);
    require_sources_of_groups(scene);
}

}  // namespace interflect::detail
