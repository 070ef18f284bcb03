#include "interflect/solver/importance/importance_weights.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// Share by which Neighbourhoods::smooth() moves the mean of a neighbourhood towards the mean of the next larger one.
constexpr float taken_over = 0.3f;

/// Importance that the rays of a box of Emission found, and the factor of the weights of its parts.
struct BoxImportance {
    PartImportance all;
    float factor = 1;
    double mean() const { return all.rays > 0 ? all.found / all.rays : 0; }
};

/// Returns factors that make weights of different boxes proportional to their importance, with exponent 1, although the
/// weights within a box have the given exponent (docs/method/method.md, Light sources that are not surfaces).
std::vector<BoxImportance> importance_of_boxes(const Emission& emission, const std::vector<PartImportance>& found,
                                               float exponent) {
    std::vector<BoxImportance> boxes(emission.box_count());
    std::vector<double> power(boxes.size(), 0.0);
    for (std::size_t i = 0; i < found.size(); ++i) {
        PartImportance& all = boxes[emission.box(i)].all;
        all.found += found[i].found;
        all.rays += found[i].rays;
        power[emission.box(i)] += channel_sum(emission.power(i));
    }
    if (boxes.size() == 1) return boxes;
    double first_moment = 0, second_moment = 0;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        first_moment += power[b] * boxes[b].mean();
        second_moment += power[b] * boxes[b].mean() * boxes[b].mean();
    }
    if (!(second_moment > 0)) return boxes;
    for (BoxImportance& box : boxes)
        box.factor = std::pow(static_cast<float>(box.mean() * first_moment / second_moment), 1 - exponent);
    return boxes;
}

/// Sets the weights of luminaire parts. The mean of its emitter supplements a part with few rays, and the mean of its
/// box an emitter with few rays.
void weigh_parts(const Emission& emission, const std::vector<PartImportance>& found, float exponent,
                 ImportanceWeights& weights) {
    constexpr std::size_t group_size = Emission::parts_per_emitter;
    constexpr double rays_of_mean = 8;  // number of rays that such a mean is worth
    const std::vector<BoxImportance> boxes = importance_of_boxes(emission, found, exponent);
    if (std::none_of(boxes.begin(), boxes.end(), [](const BoxImportance& box) { return box.all.rays > 0; })) return;
    weights.parts.resize(found.size());
    weights.parts_nearby.resize(found.size());
    for (std::size_t begin = 0; begin < found.size(); begin += group_size) {
        const BoxImportance& box = boxes[emission.box(begin)];
        PartImportance group{rays_of_mean * box.mean(), rays_of_mean};
        for (std::size_t i = begin; i < begin + group_size; ++i) {
            group.found += found[i].found;
            group.rays += found[i].rays;
        }
        const double mean = group.found / group.rays;
        for (std::size_t i = begin; i < begin + group_size; ++i) {
            const double own = (found[i].found + rays_of_mean * mean) / (found[i].rays + rays_of_mean);
            weights.parts[i] = box.factor * std::pow(static_cast<float>(own), exponent);
            weights.parts_nearby[i] = box.factor * std::pow(static_cast<float>(mean), exponent);
        }
    }
}

void pow_each(std::span<float> numbers, float exponent) {
    if (exponent == 0.75f) {  // the default: square roots allow vector code
        for (float& x : numbers) x = std::sqrt(x) * std::sqrt(std::sqrt(x));
    } else {
        for (float& x : numbers) x = std::pow(x, exponent);
    }
}

}  // namespace

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

ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission, const std::vector<PartImportance>& found) {
    const SolveOptions& o = so_far.options;
    const ElementForest& forest = *so_far.forest;
    if (importance_use(so_far) == ImportanceUse::off || o.experimental.beta == 1) return {};
    const Importance psi = importance_use(so_far) == ImportanceUse::direct ? Importance(so_far.view_importance)
                           : o.experimental.total_importance               ? importance_of(so_far)
                                                                           : Importance(so_far.indirect_importance);
    ImportanceWeights weights{
        smoothed_importance(forest, psi, o.importance.smoothing, o.importance.exponent), {}, {}, {}};
    weigh_parts(emission, found, static_cast<float>(o.importance.exponent), weights);
    if (neighbourhoods.empty() || o.importance.smoothing == 0) return weights;
    weights.nearby.resize(forest.patch_count());
    for (PatchIndex i{0}; i < forest.patch_count(); ++i) weights.nearby[i] = psi[i];
    neighbourhoods.smooth(forest, weights.nearby, taken_over);
    parallel_for_indices(weights.nearby.size(), [&](std::size_t i) {
        weights.nearby[i] = std::pow(weights.nearby[i], static_cast<float>(o.importance.exponent));
    });
    return weights;
}

bool weighs_by_indirect_importance(const Solution& so_far) {
    return importance_use(so_far) == ImportanceUse::full && !so_far.options.experimental.total_importance &&
           so_far.options.experimental.beta != 1;
}

std::vector<float> element_weights(const Solution& so_far, std::span<const float> indirect_importance) {
    const ImportanceOptions& o = so_far.options.importance;
    const auto first_new = static_cast<std::uint32_t>(indirect_importance.size());
    std::vector<float> weights = smoothed_importance(*so_far.forest, Importance(indirect_importance), o.smoothing,
                                                     o.exponent, indirect_importance.size());
    inherit(*so_far.forest, first_new, weights);
    return weights;
}

std::vector<float> smoothed_importance(const ElementForest& forest, const Importance& importance, double from_parent,
                                       double exponent, std::size_t elements) {
    const auto share = static_cast<float>(from_parent), power = static_cast<float>(exponent);
    std::vector<float> weights(elements);
    parallel_for_ranges(weights.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) weights[e] = importance[e];
    });
    forest.for_siblings_from_roots([&](ElementIndex first) {
        if (first >= elements) return;
        const float parent = weights[forest.parent(first)];
        for (ElementIndex e = first; e < first + 4; ++e) weights[e] += share * (parent - weights[e]);
    });
    if (power == 1) return weights;
    parallel_for_ranges(weights.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        pow_each(std::span(weights).subspan(begin, end - begin), power);
    });
    return weights;
}

}  // namespace interflect::detail
