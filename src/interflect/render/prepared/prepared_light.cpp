#include "interflect/render/prepared/prepared_light.h"

#include <utility>
#include <vector>

#include "interflect/base/sums/common_stop.h"
#include "interflect/render/prepared/seen_light.h"
#include "interflect/render/prepared/seen_sources.h"

namespace interflect::detail {

KnownLight known_light(const TracedScene& scene, const KnownIrradiance& known, std::span<const SurfacePoint> points,
                       std::uint64_t seed) {
    KnownLight light(scene.scene, scene.geometry, known);
    sample_seen_light(light, scene, points, seed);
    return light;
}

PreparedLight::PreparedLight(const PathPlan& plan, const KnownIrradiance* known, const Monitor& monitor) : plan_(plan) {
    const CommonStop stop(monitor.stop, monitor.ranks);
    const std::vector<SurfacePoint> points = first_points(plan, stop.within_process());
    if (auto seen = seen_sources(plan.scene, points, plan.options.seed)) sources_.emplace(std::move(*seen));
    if (!known) return;
    light_.emplace(known_light(plan.scene, *known, points, plan.options.seed));
    if (!known->is_interpolated) return;
    field_.emplace(this->plan(), points, monitor);
    guide_.emplace(plan.scene, *field_, plan.options.seed, stop);
    rays_ = field_->rays() + guide_->rays();
    hybrid_ = {&*field_, &*guide_};
}

PathPlan PreparedLight::plan() const {
    PathPlan plan = plan_;
    if (sources_) plan.seen_sources = &*sources_;
    if (!light_) return plan;
    plan.known = &*light_;
    plan.first_shadow_rays = first_shadow_rays;
    if (guide_) plan.hybrid = &hybrid_;
    return plan;
}

}  // namespace interflect::detail
