#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Merges a step by Eq. 6, Prikryl et al. 2000, with tau = N / (history + N) per element; its history is the number of
/// rays in its mean. A larger tau of newer children only redistributes their parent's mean, which preserves power.
void merge(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const IterationPlan& plan);
void merge(const SolverState& state, std::vector<float>& mean, const std::vector<float>& received,
           const IterationPlan& plan);

/// Merges estimates that are not shot again; means may be negative. Siblings are averaged over their own rays. The
/// difference from their parent's mean, which may contain more rays, is divided in proportion to their noise, so noise
/// does not spread to dark siblings.
void merge_independent(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                       const IterationPlan& plan);

/// Merges each light group. The light of groups dimmed to 0 does not change.
void merge(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);
void merge_independent(const SolverState& state, GroupLight& mean, const GroupLight& received,
                       const IterationPlan& plan);

/// Averages escaped power like irradiance (Eq. 6). The power of one iteration includes light of the previous one.
void merge_escaped_power(SolverState& state, const RgbD& escaped, const IterationPlan& plan);

/// Adds the rays of an iteration. New elements keep only `inherited_weight` of their history, because their inherited
/// mean is too smooth.
void update_history(SolverState& state, const IterationPlan& plan);

}  // namespace interflect::detail
