#include "interflect/solver/error/finish_solution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/error/error_estimate.h"
#include "interflect/solver/error/sibling_variation.h"

namespace interflect::detail {

namespace {

/// Clamps each group to zero, then rescales the groups to sum to the total.
void share_among_groups(const std::vector<Rgb>& irradiance, GroupLight& groups) {
    for (std::size_t e = 0; e < irradiance.size() && !groups.empty(); ++e)
        for (int c = 0; c < 3; ++c) {
            float sum = 0;
            for (std::vector<Rgb>& of_group : groups) sum += of_group[e][c] = std::max(0.0f, of_group[e][c]);
            for (std::vector<Rgb>& of_group : groups) of_group[e][c] *= sum > 0 ? irradiance[e][c] / sum : 0;
        }
}

}  // namespace

void finish_solution(SolverState& state) {
    const ElementForest& forest = *state.forest;
    Solution& solution = state.solution;
    const ElementErrors errors = element_errors(state, ErrorMeasure::surfaces);
    solution.standard_error.resize(forest.size());
    solution.discretisation_error.resize(forest.size());
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        const float within = std::max(0.0f, signal_among_siblings(state, e)) / 3;  // 1/4 + 1/16 + ... of the signal
        solution.standard_error[e] = std::sqrt(errors.noise[e]);
        solution.discretisation_error[e] = std::sqrt(std::max(0.0f, errors.bias[e]) + within);
    }
    state.streams.used.resize(forest.size(), 0);
    solution.rays.assign(state.streams.used.begin(), state.streams.used.end());
    std::vector<Rgb> reduced = solution.irradiance;
    GroupLight reduced_groups = solution.groups;
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        const std::uint32_t parent = forest.parent(first);
        const Shrinkage shrinkage = shrinkage_of(state, first);
        const auto differences = [&](const std::vector<Rgb>& irradiance) {
            std::array<Rgb, 4> difference;
            Rgb sum(0);
            float area = 0;
            for (std::uint32_t k = 0; k < 4; ++k) {
                difference[k] = shrinkage.kept[k] * (irradiance[first + k] - irradiance[parent]);
                sum += forest.area(first + k) * difference[k], area += forest.area(first + k);
            }
            for (std::uint32_t k = 0; k < 4; ++k) difference[k] -= shrinkage.noise[k] * sum / area;
            return difference;
        };
        const std::array<Rgb, 4> difference = differences(solution.irradiance);
        Rgb factor(1);  // If a child would become negative, scale all four differences equally.
        for (int c = 0; c < 3; ++c) {
            float lowest = 0;
            for (const Rgb& d : difference) lowest = std::min(lowest, d[c]);
            const float mean = reduced[parent][c];
            if (-lowest > mean) factor[c] = mean / -lowest;
            for (std::uint32_t k = 0; k < 4; ++k)
                reduced[first + k][c] = std::max(0.0f, mean + factor[c] * difference[k][c]);
        }
        for (std::size_t g = 0; g < reduced_groups.size(); ++g) {
            const std::array<Rgb, 4> of_group = differences(solution.groups[g]);
            for (std::uint32_t k = 0; k < 4; ++k)
                reduced_groups[g][first + k] = reduced_groups[g][parent] + factor * of_group[k];
        }
    });
    solution.irradiance = std::move(reduced);
    for (std::size_t g = 0; g < reduced_groups.size(); ++g)
        if (solution.dimming[g] == 0) reduced_groups[g].assign(forest.size(), Rgb(0));
    share_among_groups(solution.irradiance, reduced_groups);
    solution.groups = std::move(reduced_groups);
}

}  // namespace interflect::detail
