#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Merges a step by Eq. 6, Prikryl et al. 2000, with tau from each element's history. Newer children have a larger tau,
/// which only changes how they share their parent's mean. So no light is lost or counted twice. Equal histories give
/// Eq. 6.
void merge(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const IterationPlan& plan);
void merge(const SolverState& state, std::vector<float>& mean, const std::vector<float>& received,
           const IterationPlan& plan);

/// Same for estimates that are not shot again. Averages differences from the parent, so means may be negative, but stay
/// unbiased with known noise.
void merge_details(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                   const IterationPlan& plan);

/// The stored light of a group dimmed to 0 does not change.
void merge(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);
void merge_details(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);

/// Averages escaped power by Eq. 6, to match the mean irradiance. A single iteration does not match, because it also
/// shoots light of the previous one. @return The mean.
RgbD merge_escaped_power(SolverState& state, const RgbD& escaped, const IterationPlan& plan);

/// Adds the rays of an iteration. New elements (index >= first_new) inherited a mean that is too smooth, so only
/// `inherited_weight` of their history counts.
void update_history(SolverState& state, const IterationPlan& plan, std::uint32_t first_new);

}  // namespace interflect::inline detail
