#include "interflect/solver/sampling/ray_plan.h"

#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/sampling/probabilities.h"

namespace interflect::detail {

namespace {

/// Share of the importance-driven rays that are sampled by the importance of neighbourhoods.
constexpr double share_of_nearby = 0.2;

MixtureWeights shares_of(const Solution& so_far, bool combined, bool nearby) {
    if (importance_use(so_far) == ImportanceUse::off) return {.power = 1};
    const SolveOptions& o = so_far.options;
    const double for_power = combined ? 1 - o.experimental.alpha : 1, driven = for_power * (1 - o.experimental.beta);
    const double by_nearby = nearby ? share_of_nearby * driven : 0;
    return {.power = for_power * o.experimental.beta,
            .weighted_power = driven - by_nearby,
            .importance = combined ? o.experimental.alpha : 0,
            .power_nearby = by_nearby};
}

}  // namespace

PowerPlan plan_power(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays) {
    RayPlan plan;
    plan.rays = rays;
    plan.light = light;
    if (light.emits() && emission.part_count() > 0) plan.emission = &emission;
    if (combined) plan.importance = importance_of(so_far);
    auto [q, non_finite_leaves, power, weighted_power] =
        mixture({materials, *so_far.forest, light, plan.importance, weights.elements, weights.nearby, plan.emission,
                 weights.parts, weights.parts_nearby},
                shares_of(so_far, combined, !weights.nearby.empty()));
    plan.q = std::move(q);
    return {std::move(plan), power, weighted_power, non_finite_leaves};
}

RayPlan plan_importance(const Materials& materials, const Solution& so_far, const Importance& importance,
                        std::int64_t rays) {
    RayPlan plan;
    plan.q = mixture({materials, *so_far.forest, {}, importance, {}}, {.importance = 1}).q;
    plan.rays = rays;
    plan.importance = importance;
    return plan;
}

}  // namespace interflect::detail
