#include "interflect/render/shared_light.h"

#include <optional>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/dimmed_irradiance.h"
#include "interflect/render/gauges/gauge_light.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/sharing/light_order.h"

namespace interflect::detail {

void share_light(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, Ranks& ranks) {
    const Monitor monitor{.on_progress = {}, .ranks = &ranks};
    std::optional<KnownIrradiance> known;
    if (solution) known.emplace(known_irradiance(scene, *solution));
    std::optional<TracedScene> traced;  // scene for gauges, created when it is first needed
    const auto scene_of_gauges = [&]() -> const TracedScene& {
        known.value().is_interpolated = true;
        if (!traced) traced.emplace(scene, ray_caster);
        return *traced;
    };
    for (;;) {
        const ReceivedOrder received = receive_order(ranks);
        const LightOrder& order = received.order;
        try {
            switch (order.kind) {
                case LightOrder::Kind::picture:
                    if (order.is_known) known.value().is_interpolated = order.is_interpolated;
                    trace_picture(scene, ray_caster, received.start, order.options, monitor,
                                  order.is_known ? &*known : nullptr, order.has_direct_sunlight);
                    break;
                case LightOrder::Kind::instant_picture:
                    trace_instant_picture(scene, ray_caster, received.start, order.options, monitor);
                    break;
                case LightOrder::Kind::gauges:
                    hybrid_irradiance(scene_of_gauges(), *known, received.gauges, order.options, monitor);
                    break;
                case LightOrder::Kind::direct_gauges:
                    direct_irradiance(scene_of_gauges(), received.gauges, order.options, monitor);
                    break;
                case LightOrder::Kind::group: {
                    const LightOfGroup group = light_of_group(scene, *solution, order.group);
                    share_light(group.scene, &group.solution, RayCaster(group.scene), ranks);
                    break;
                }
                case LightOrder::Kind::end:
                    return;
            }
        } catch (const Stopped&) {  // rank 0 throws it as well, and reports it
        }
    }
}

LightOfGroup light_of_group(const Scene& scene, const Solution& solution, std::size_t group) {
    SourceGroups groups = source_groups(scene);
    groups.names = solution.group_names;
    std::vector<float> factors(groups.size(), 0);
    factors[group] = 1;
    LightOfGroup light{dimmed(scene, groups, factors), solution};
    replace_irradiance(light.solution, std::move(light.solution.groups[group]));
    light.solution.groups.clear();
    return light;
}

void end_shared_light(Ranks* ranks) { give_order(ranks, {}); }

}  // namespace interflect::detail
