#include "interflect/solver/iteration/merge.h"

#include <algorithm>
#include <array>
#include <limits>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Maps a child's value to factor * value + offset, so that the mean of the children becomes their parent's mean.
template <class T>
struct Scaling {
    T factor, offset;
};
Scaling<float> scaling(float children_mean, float parent_mean) {
    const bool is_scaled = children_mean > 0;
    return {is_scaled ? parent_mean / children_mean : 0, is_scaled ? 0 : parent_mean};
}
Scaling<Rgb> scaling(const Rgb& children_mean, const Rgb& parent_mean) {
    const auto [fx, ox] = scaling(children_mean.x, parent_mean.x);
    const auto [fy, oy] = scaling(children_mean.y, parent_mean.y);
    const auto [fz, oz] = scaling(children_mean.z, parent_mean.z);
    return {Rgb(fx, fy, fz), Rgb(ox, oy, oz)};
}

/// Number of rays in the mean so far: the rays averaged into an element, at most `most`, plus the `first` rays of a
/// first estimate.
struct Earlier {
    float most = std::numeric_limits<float>::infinity(), first = 0;

    float rays(float history) const { return std::min(history, most) + first; }
};

template <class T>
void merge_into(const LightState& light, std::vector<T>& mean, const std::vector<T>& received,
                const TracedIteration& iteration, const Earlier& earlier = {}) {
    const ElementForest& forest = *light.forest;
    const auto rays = static_cast<float>(iteration.weight);  // number N of Eq. 6
    const auto merge_one = [&](ElementIndex e) {
        const float tau = iteration.plan.warms_up ? 1.0f : rays / (earlier.rays(light.history[e]) + rays);
        mean[e] += tau * (received[e] - mean[e]);
    };
    parallel_for_ranges(forest.patch_count(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) merge_one(e);
    });
    forest.for_siblings_from_roots([&](ElementIndex first) {
        T sum(0);
        float area = 0;
        for (ElementIndex e = first; e < first + 4; ++e) {
            merge_one(e);
            sum += mean[e] * forest.area(e);
            area += forest.area(e);
        }
        const auto [factor, offset] = scaling(sum / area, mean[forest.parent(first)]);
        for (ElementIndex e = first; e < first + 4; ++e) mean[e] = mean[e] * factor + offset;
    });
    pull(forest, mean);
}

}  // namespace

void merge(const LightState& light, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const TracedIteration& iteration) {
    merge_into(light, mean, received, iteration);
}
void merge_independent(const LightState& light, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                       const TracedIteration& iteration) {
    const ElementForest& forest = *light.forest;
    const auto rays = static_cast<float>(iteration.weight);
    const auto merged = [&](ElementIndex e) {
        return mean[e] + (received[e] - mean[e]) * (rays / (light.history[e] + rays));
    };
    parallel_for_ranges(forest.patch_count(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) mean[e] = merged(e);
    });
    forest.for_siblings_from_roots([&](ElementIndex first) {
        Rgb sum(0);
        float area = 0;
        for (ElementIndex e = first; e < first + 4; ++e) {
            mean[e] = merged(e);
            sum += mean[e] * forest.area(e);
            area += forest.area(e);
        }
        const Rgb missing = mean[forest.parent(first)] - sum / area;
        const std::array<float, 4> shares =
            light.noise.shares(forest, light.solution.irradiance, first, light.history[first] + rays);
        for (std::uint32_t k = 0; k < 4; ++k) mean[first + k] += missing * shares[k];
    });
}

void merge_importance(LightState& light, const RayTotals& rays, const std::vector<float>& received,
                      const TracedIteration& iteration) {
    Earlier earlier;
    earlier.first = static_cast<float>(rays.of_first_importance);
    if (rays.of_other_views > 0) earlier.most = static_cast<float>(rays.schedule.averaged_rays() - rays.of_other_views);
    merge_into(light, light.solution.indirect_importance, received, iteration, earlier);
}

void merge(const LightState& light, GroupLight& mean, const GroupLight& received, const TracedIteration& iteration) {
    for (std::size_t g = 0; g < mean.size(); ++g)
        if (light.solution.dimming[g] > 0) merge(light, mean[g], received[g], iteration);
}
void merge_independent(const LightState& light, GroupLight& mean, const GroupLight& received,
                       const TracedIteration& iteration) {
    const std::vector<float>& dimming = light.solution.dimming;  // empty without groups
    for (std::size_t g = 0; g < mean.size(); ++g)
        if (dimming.empty() || dimming[g] > 0) merge_independent(light, mean[g], received[g], iteration);
}

void merge_escaped_power(LightState& light, const RgbD& escaped, const TracedIteration& iteration) {
    const auto rays = static_cast<double>(iteration.weight);
    const double tau = iteration.plan.warms_up ? 1 : rays / (light.escaped_power_rays + rays);
    light.escaped_power += (escaped - light.escaped_power) * tau;
    light.escaped_power_rays = iteration.plan.warms_up ? 0 : light.escaped_power_rays + rays;
}

void update_history(LightState& light, const TracedIteration& iteration) {
    const auto rays = static_cast<float>(iteration.weight),
               inherited = static_cast<float>(light.options().experimental.inherited_weight);
    light.history.change([&](ElementIndex e, float before) {
        return iteration.plan.warms_up ? 0.0f : (before + rays) * (e < iteration.plan.old_elements ? 1.0f : inherited);
    });
}

}  // namespace interflect::detail
