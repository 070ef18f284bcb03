#include "interflect/solver/transport_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/probabilities.h"

namespace interflect::inline detail {

namespace {

/// Number of rays at which ExperimentalOptions::epsilon is the threshold.
constexpr double rays_at_epsilon = 20e6;
/// Share of importance-driven rays that are sampled by neighbourhood importance.
constexpr double share_of_nearby = 0.2;
/// Share of the next larger neighbourhood in Neighbourhoods::smooth().
constexpr float taken_over = 0.3f;

/// Shares of the weights in Eq. 3, 9, 10, or Eq. 11 if combined.
MixtureWeights power_step_shares(const Solution& so_far, bool combined, bool nearby) {
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

bool refines_by_variance(const SolveOptions& o) {
    return o.method.refines && o.method.follows_variance && !o.experimental.one_bounce &&
           o.refinement.criterion == RefinementCriterion::variance;
}

ImportanceUse importance_use(const Solution& so_far) {
    return so_far.view_importance.empty() ? ImportanceUse::off : so_far.options.method.importance;
}

Importance importance_of(const Solution& so_far) {
    return Importance(so_far.view_importance, so_far.indirect_importance);
}

std::vector<float> total_importance(const Solution& so_far) {
    std::vector<float> psi = so_far.view_importance;
    for (std::size_t e = 0; e < psi.size(); ++e) psi[e] += so_far.indirect_importance[e];
    return psi;
}

namespace {

/// Mean importance in a box of light from outside, and the factor for its parts.
struct BoxImportance {
    PartImportance all;
    float factor = 1;
    double mean() const { return all.rays > 0 ? all.found / all.rays : 0; }
};

/// The exponent allows for few valuable rays among many. Boxes already separate these, so the factor restores the
/// exponent 1 between boxes. It is 1 for a box of typical importance.
std::vector<BoxImportance> importance_of_boxes(const Emission& emission, const std::vector<PartImportance>& found,
                                               float exponent) {
    std::vector<BoxImportance> boxes(emission.box_count());
    std::vector<double> power(boxes.size(), 0.0);
    for (std::size_t i = 0; i < found.size(); ++i) {
        PartImportance& all = boxes[emission.box(i)].all;
        all.found += found[i].found, all.rays += found[i].rays;
        power[emission.box(i)] += channel_sum(emission.power(i));
    }
    if (boxes.size() == 1) return boxes;
    double first = 0, second = 0;  // moments of importance
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        first += power[b] * boxes[b].mean();
        second += power[b] * boxes[b].mean() * boxes[b].mean();
    }
    if (!(second > 0)) return boxes;
    for (BoxImportance& box : boxes)
        box.factor = std::pow(static_cast<float>(box.mean() * first / second), 1 - exponent);
    return boxes;
}

/// Computes the importance of parts, and its mean over the parts of an emitter. The mean serves as a prior with the
/// weight of `rays_of_mean` rays.
void weigh_parts(const Emission& emission, const std::vector<PartImportance>& found, float exponent,
                 ImportanceWeights& weights) {
    constexpr std::size_t alike = Emission::parts_per_emitter;
    constexpr double rays_of_mean = 8;
    const std::vector<BoxImportance> boxes = importance_of_boxes(emission, found, exponent);
    if (std::none_of(boxes.begin(), boxes.end(), [](const BoxImportance& box) { return box.all.rays > 0; })) return;
    weights.parts.resize(found.size());
    weights.parts_nearby.resize(found.size());
    for (std::size_t begin = 0; begin < found.size(); begin += alike) {
        const BoxImportance& box = boxes[emission.box(begin)];
        PartImportance group{rays_of_mean * box.mean(), rays_of_mean};
        for (std::size_t i = begin; i < begin + alike; ++i) group.found += found[i].found, group.rays += found[i].rays;
        const double mean = group.found / group.rays;
        for (std::size_t i = begin; i < begin + alike; ++i) {
            const double own = (found[i].found + rays_of_mean * mean) / (found[i].rays + rays_of_mean);
            weights.parts[i] = box.factor * std::pow(static_cast<float>(own), exponent);
            weights.parts_nearby[i] = box.factor * std::pow(static_cast<float>(mean), exponent);
        }
    }
}

}  // namespace

ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission, const std::vector<PartImportance>& found) {
    const SolveOptions& o = so_far.options;
    const ElementForest& forest = *so_far.forest;
    if (power_step_shares(so_far, false, false).weighted_power == 0) return {};
    const Importance psi = importance_use(so_far) == ImportanceUse::direct ? Importance(so_far.view_importance)
                           : o.experimental.total_importance               ? importance_of(so_far)
                                                                           : Importance(so_far.indirect_importance);
    ImportanceWeights weights{
        importance_weight(forest, psi, o.importance.smoothing, o.importance.exponent), {}, {}, {}};
    weigh_parts(emission, found, static_cast<float>(o.importance.exponent), weights);
    if (neighbourhoods.empty() || o.importance.smoothing == 0) return weights;
    for (std::uint32_t i = 0; i < forest.patch_count(); ++i) weights.nearby.push_back(psi[i]);
    neighbourhoods.smooth(forest, weights.nearby, taken_over);
    for (float& x : weights.nearby) x = std::pow(x, static_cast<float>(o.importance.exponent));
    return weights;
}

PowerStep power_step(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays) {
    TransportStep step;
    const MixtureWeights shares = power_step_shares(so_far, combined, !weights.nearby.empty());
    step.light = step.known_light = light;
    if (light.emits() && emission.part_count() > 0) step.emission = &emission;
    if (combined) step.importance = importance_of(so_far);
    auto [q, lost_leaves, power, weighted_power] =
        mixture({materials, *so_far.forest, light, step.importance, weights.elements, weights.nearby, step.emission,
                 weights.parts, weights.parts_nearby},
                shares);
    step.q = std::move(q);
    step.rays = rays;
    step.importance_at_patches = so_far.options.experimental.importance_at_patches;
    return {std::move(step), power, weighted_power, lost_leaves};
}

TransportStep importance_step(const Materials& materials, const Solution& so_far, const Importance& importance,
                              std::int64_t rays) {
    TransportStep step;
    step.q = mixture({materials, *so_far.forest, {}, importance, {}}, {.importance = 1}).q;
    step.rays = rays;
    step.importance = importance;
    step.importance_at_patches = so_far.options.experimental.importance_at_patches;
    return step;
}

Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area) {
    const double fall =
        std::pow(rays_at_epsilon / static_cast<double>(rays), so_far.options.experimental.epsilon_decay);
    Oracle oracle;
    oracle.refines = true;
    oracle.by_importance = importance_use(so_far) != ImportanceUse::off;
    oracle.threshold = so_far.options.experimental.epsilon * fall * reference_power(so_far);
    if (oracle.by_importance) {
        // An element with underestimated importance would stay coarse.
        oracle.importance =
            importance_weight(*so_far.forest, importance_of(so_far), so_far.options.importance.smoothing, 1);
        oracle.threshold *= reference_importance(so_far, oracle.importance);
    }
    oracle.min_area = static_cast<float>(min_area);
    oracle.max_elements = so_far.options.refinement.max_elements;
    return oracle;
}

double reference_power(const Solution& so_far) {
    const ElementForest& forest = *so_far.forest;
    if (so_far.view_importance.empty()) return channel_sum(so_far.emitted_power) / 3;
    double seen = 0, area = 0;  // mean irradiance of the picture; visible area [m^2]
    for (std::uint32_t i = 0; i < forest.patch_count(); ++i) {
        if (!(so_far.view_importance[i] > 0)) continue;
        seen += static_cast<double>(so_far.view_importance[i]) * forest.area(i) *
                channel_sum(RgbD(so_far.irradiance[i])) / 3;
        area += forest.area(i);
    }
    return seen > 0 ? seen * area : channel_sum(so_far.emitted_power) / 3;
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

}  // namespace interflect::inline detail
