#include "interflect/solver/error/finish_solution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_estimate.h"
#include "interflect/solver/shrinkage/cluster_shrinkage.h"
#include "interflect/solver/shrinkage/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Limits direct light to the range from zero to the total light.
void limit_direct(const Solution& solution, GroupLight& direct) {
    for (std::size_t g = 0; g < direct.size(); ++g) {
        const std::vector<Rgb>& all = solution.groups.empty() ? solution.irradiance : solution.groups[g];
        for (std::size_t e = 0; e < all.size(); ++e)
            for (int c = 0; c < 3; ++c) direct[g][e][c] = std::clamp(direct[g][e][c], 0.0f, all[e][c]);
    }
}

/// Clamps each group to zero, then rescales the groups to sum to the total.
void share_among_groups(const std::vector<Rgb>& irradiance, GroupLight& groups) {
    for (std::size_t e = 0; e < irradiance.size() && !groups.empty(); ++e)
        for (int c = 0; c < 3; ++c) {
            float sum = 0;
            for (std::vector<Rgb>& of_group : groups) sum += of_group[e][c] = std::max(0.0f, of_group[e][c]);
            for (std::vector<Rgb>& of_group : groups) of_group[e][c] *= sum > 0 ? irradiance[e][c] / sum : 0;
        }
}

/// Replaces the mean of each patch by the average of the shrunk means over all trees of clusters. Scales the elements
/// of the patch by the same factor.
/// @param unreduced  The same light before any shrinkage.
void reduce_patches(const SolverState& state, std::span<const Rgb> unreduced, std::vector<Rgb>& light) {
    if (state.inputs.clusters.empty()) return;
    const ElementForest& forest = *state.light.forest;
    std::vector<Rgb> means(forest.patch_count(), Rgb(0));
    const float weight = 1 / static_cast<float>(state.inputs.clusters.size());
    std::vector<std::vector<Rgb>> of_trees(state.inputs.clusters.size());
    parallel_for_ranges(of_trees.size(), 1, [&](std::size_t tree, std::size_t) {
        of_trees[tree] =
            ClusterShrinkage(state.light, state.inputs.clusters[tree], unreduced).means(state.sampling.view.rays());
    });
    for (const std::vector<Rgb>& of_tree : of_trees)
        for (std::size_t p = 0; p < means.size(); ++p) means[p] += weight * of_tree[p];
    for (std::uint32_t i = forest.size(); i-- > 0;) {  // patches last, because their elements need the old means
        const ElementIndex e(i);
        const PatchIndex patch = forest.patch(e);
        for (int c = 0; c < 3; ++c)
            light[e][c] = light[patch][c] > 0 ? light[e][c] * (means[patch][c] / light[patch][c]) : means[patch][c];
    }
}

/// Sets the light of four siblings to the mean plus the differences. Scales all four differences if a sibling would be
/// negative. Returns the factors, one per channel.
Rgb set_siblings(std::vector<Rgb>& light, ElementIndex first, const Rgb& mean, const std::array<Rgb, 4>& difference) {
    Rgb factor(1);
    for (int c = 0; c < 3; ++c) {
        float lowest = 0;
        for (const Rgb& d : difference) lowest = std::min(lowest, d[c]);
        if (-lowest > mean[c]) factor[c] = mean[c] / -lowest;
        for (std::uint32_t k = 0; k < 4; ++k)  // the maximum corrects rounding
            light[first + k][c] = std::max(0.0f, mean[c] + factor[c] * difference[k][c]);
    }
    return factor;
}

}  // namespace

void finish_solution(SolverState& state) {
    const ElementForest& forest = *state.light.forest;
    Solution& solution = state.light.solution;

    // Compute the errors and the numbers of rays of the elements
    const ElementErrors errors = element_errors(state.inputs, state.light, ErrorMeasure::surfaces);
    solution.standard_error.resize(forest.size());
    solution.discretisation_error.resize(forest.size());
    const auto set_errors = [&](ElementIndex begin, std::uint32_t count, float signal) {
        // Finer levels add 1/4 + 1/16 + ... = 1/3 of the signal.
        const float within = std::max(0.0f, signal) / 3;
        for (ElementIndex e = begin; e < begin + count; ++e) {
            solution.standard_error[e] = std::sqrt(errors.noise[e]);
            solution.discretisation_error[e] = std::sqrt(std::max(0.0f, errors.bias[e]) + within);
        }
    };
    set_errors(ElementIndex(0), forest.patch_count(), 0);
    forest.for_siblings_from_roots(
        [&](ElementIndex first) { set_errors(first, 4, signal_among_siblings(state.light, first)); });
    Counts& used = state.sampling.streams.used;
    used.resize(forest.size());
    solution.rays.resize(forest.size());
    for (std::size_t e = 0; e < used.size(); ++e) solution.rays[e] = static_cast<float>(used[e]);

    // Shrink the differences of siblings, from the patches down to the leaves
    std::vector<Rgb> unreduced = solution.irradiance, reduced = solution.irradiance;
    GroupLight reduced_groups = solution.groups, reduced_direct = solution.direct;
    forest.for_siblings_from_roots([&](ElementIndex first) {
        const ElementIndex parent = forest.parent(first);
        const Shrinkage shrinkage = shrinkage_of(state.light, first, sibling_variation(state.light, first));
        const auto differences = [&](const std::vector<Rgb>& irradiance) {
            std::array<Rgb, 4> difference;
            Rgb sum(0);
            float area = 0;
            for (std::uint32_t k = 0; k < 4; ++k) {
                difference[k] = shrinkage.kept[k] * (irradiance[first + k] - irradiance[parent]);
                sum += forest.area(first + k) * difference[k];
                area += forest.area(first + k);
            }
            for (std::uint32_t k = 0; k < 4; ++k) difference[k] -= shrinkage.noise[k] * sum / area;
            return difference;
        };
        std::array<Rgb, 4> measured;
        for (std::uint32_t k = 0; k < 4; ++k)
            measured[k] = solution.irradiance[first + k] - solution.irradiance[parent];
        set_siblings(unreduced, first, unreduced[parent], measured);
        const Rgb factor = set_siblings(reduced, first, reduced[parent], differences(solution.irradiance));
        const auto reduce = [&](const GroupLight& light, GroupLight& reduced_light) {
            for (std::size_t g = 0; g < light.size(); ++g) {
                const std::array<Rgb, 4> of_group = differences(light[g]);
                for (std::uint32_t k = 0; k < 4; ++k)
                    reduced_light[g][first + k] = reduced_light[g][parent] + factor * of_group[k];
            }
        };
        reduce(solution.groups, reduced_groups);
        reduce(solution.direct, reduced_direct);
    });

    // Shrink the differences of patches
    reduce_patches(state, solution.irradiance, reduced);
    for (std::size_t g = 0; g < reduced_groups.size(); ++g)
        reduce_patches(state, solution.groups[g], reduced_groups[g]);
    for (std::size_t g = 0; g < reduced_direct.size(); ++g)
        reduce_patches(state, solution.direct[g], reduced_direct[g]);

    // Keep the light before noise reduction if it differs
    solution.unreduced_irradiance.clear();
    if (solution.options.experimental.shrinkage && unreduced != reduced)
        solution.unreduced_irradiance = std::move(unreduced);

    // Make light groups and direct light consistent with the total
    solution.irradiance = std::move(reduced);
    for (std::size_t g = 0; g < reduced_groups.size(); ++g)
        if (solution.dimming[g] == 0) reduced_groups[g].assign(forest.size(), Rgb(0));
    share_among_groups(solution.irradiance, reduced_groups);
    solution.groups = std::move(reduced_groups);
    limit_direct(solution, reduced_direct);
    solution.direct = std::move(reduced_direct);
}

}  // namespace interflect::detail
