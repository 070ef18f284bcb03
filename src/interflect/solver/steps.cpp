#include "interflect/solver/steps.h"

#include <cmath>
#include <utility>

#include "interflect/solver/probabilities.h"

namespace interflect {

namespace {

/// SolveOptions::epsilon is the threshold after so many rays.
constexpr double rays_at_epsilon = 20e6;

/// What drives the rays of power, of every element: what is seen, or total or indirect importance.
std::vector<float> driver(const Solution& so_far) {
    const SolveOptions& o = so_far.options;
    const std::vector<float>& psi = importance_use(so_far) == ImportanceUse::direct ? so_far.view_importance
                                    : o.total_importance                            ? total_importance(so_far)
                                                                                    : so_far.indirect_importance;
    return driving_importance(*so_far.forest, psi, o.importance_smoothing, o.importance_exponent);
}

/// Sampling weights of a step that carries power: Eq. 3, 9, 10, and 11 where it carries importance too.
std::vector<double> power_step_weights(const Solution& so_far, const Sampled& s, const std::vector<Rgb>& radiosity,
                                       bool combined) {
    std::vector<double> by_power = power_weights(s, radiosity);
    if (importance_use(so_far) == ImportanceUse::off) return by_power;
    const SolveOptions& o = so_far.options;
    const double for_power = combined ? 1 - o.alpha : 1;
    std::vector<double> q(s.leaves.size(), 0.0);
    mix_in(q, driven_weights(s, radiosity, driver(so_far)), for_power * (1 - o.beta));
    mix_in(q, by_power, for_power * o.beta);
    if (combined) mix_in(q, reflected_importance_weights(s, total_importance(so_far)), o.alpha);
    return q;
}

}  // namespace

ImportanceUse importance_use(const Solution& so_far) {
    return so_far.view_importance.empty() ? ImportanceUse::off : so_far.options.method.importance;
}

std::vector<float> total_importance(const Solution& so_far) {
    std::vector<float> psi = so_far.view_importance;
    for (std::size_t e = 0; e < psi.size(); ++e) psi[e] += so_far.indirect_importance[e];
    return psi;
}

TransportStep power_step(const Surfaces& surfaces, const Solution& so_far, std::vector<Rgb> radiosity, bool combined,
                         std::int64_t rays) {
    TransportStep step;
    step.leaves = so_far.forest->leaves();
    step.q = power_step_weights(so_far, {surfaces, *so_far.forest, step.leaves}, radiosity, combined);
    step.rays = rays;
    step.radiosity = std::move(radiosity);
    if (combined) step.importance = total_importance(so_far);
    step.carries_importance = combined;
    step.importance_at_patches = !so_far.options.importance_at_elements;
    return step;
}

TransportStep importance_step(const Surfaces& surfaces, const Solution& so_far, std::vector<float> importance,
                              std::int64_t rays) {
    TransportStep step;
    step.leaves = so_far.forest->leaves();
    step.q = reflected_importance_weights({surfaces, *so_far.forest, step.leaves}, importance);
    step.rays = rays;
    step.importance = std::move(importance);
    step.carries_importance = true;
    step.importance_at_patches = !so_far.options.importance_at_elements;
    return step;
}

Oracle make_oracle(const Solution& so_far, const TransportStep& step, std::int64_t rays, double smallest_area) {
    const double fall = std::pow(rays_at_epsilon / static_cast<double>(rays), so_far.options.epsilon_decay);
    Oracle oracle;
    oracle.refines = true;
    oracle.by_importance = importance_use(so_far) != ImportanceUse::off;
    oracle.threshold = so_far.options.epsilon * fall * reference_power(so_far, step.radiosity);
    if (oracle.by_importance) {
        // An element whose importance was estimated too low would stay coarse for ever: hence a part of its parent's.
        oracle.importance =
            driving_importance(*so_far.forest, total_importance(so_far), so_far.options.importance_smoothing, 1);
        oracle.threshold *= reference_importance(so_far, oracle.importance);
    }
    oracle.smallest_area = static_cast<float>(smallest_area);
    oracle.most_elements = so_far.options.most_elements;
    return oracle;
}

double reference_power(const Solution& so_far, const std::vector<Rgb>& radiosity) {
    const ElementForest& forest = *so_far.forest;
    if (so_far.view_importance.empty()) return channel_sum(so_far.emitted_power) / 3;
    double seen = 0, area = 0;  // sum of V B, the mean radiosity of the picture; of the patches in it [m^2]
    for (std::uint32_t i = 0; i < forest.patch_count(); ++i) {
        if (!(so_far.view_importance[i] > 0)) continue;
        seen += static_cast<double>(so_far.view_importance[i]) * forest.area(i) * channel_sum(RgbD(radiosity[i])) / 3;
        area += forest.area(i);
    }
    return seen * area;
}

double reference_importance(const Solution& so_far, const std::vector<float>& psi) {
    const ElementForest& forest = *so_far.forest;
    double sum = 0, area = 0;
    for (std::uint32_t i = 0; i < forest.patch_count(); ++i) {
        if (!(so_far.view_importance[i] > 0)) continue;
        sum += static_cast<double>(psi[i]) * forest.area(i);
        area += forest.area(i);
    }
    return area > 0 ? sum / area : 0;
}

}  // namespace interflect
