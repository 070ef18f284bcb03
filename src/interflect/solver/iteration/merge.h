#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Merges a step by Eq. 6, Prikryl et al. 2000, with tau = N / (history + N) for each element. Newer children have a
/// larger tau. It only changes how they share their parent's mean, so no light is lost or counted twice. Equal
/// histories give Eq. 6 itself.
void merge(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const IterationPlan& plan);
void merge(const SolverState& state, std::vector<float>& mean, const std::vector<float>& received,
           const IterationPlan& plan);

/// Merges estimates that are not shot again. Siblings are averaged over their own rays; their parent's mean may contain
/// more rays, and the difference is divided among them in proportion to their noise. So the noise of a bright
/// sibling does not spread to a dark one. Means may be negative.
void merge_independent(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                       const IterationPlan& plan);

/// Merges each light group. The stored light of a group dimmed to 0 does not change.
void merge(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);
void merge_independent(const SolverState& state, GroupLight& mean, const GroupLight& received,
                       const IterationPlan& plan);

/// Averages escaped power by Eq. 6 to match the mean irradiance. The power of one iteration does not match, because it
/// includes light of the previous one.
void merge_escaped_power(SolverState& state, const RgbD& escaped, const IterationPlan& plan);

/// Adds the rays of an iteration. New elements (IterationPlan::old_elements) inherited a mean that is too smooth, so
/// only `inherited_weight` of their history counts.
void update_history(SolverState& state, const IterationPlan& plan);

}  // namespace interflect::detail
