#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Merges a step by Eq. 6, Prikryl et al. 2000, with a tau per element: the N new rays relative to all rays of its
/// mean. All patches have the same tau. Children that were created later have a larger one, which only affects how they
/// share their parent's mean. No light is lost or counted twice. With equal histories this is Eq. 6 itself.
void merge(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const IterationPlan& plan);
void merge(const SolverState& state, std::vector<float>& mean, const std::vector<float>& received,
           const IterationPlan& plan);

/// Same, for estimates that are not shot again. Averages the differences of siblings from their parent, with the tau of
/// the siblings; means may become negative. They stay unbiased with known noise even if siblings are under-sampled.
void merge_details(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                   const IterationPlan& plan);

/// Same for the shares of light groups. The stored light of a group that is dimmed to 0 does not change.
void merge(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);
void merge_details(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);

/// Merges escaped power by Eq. 6, so it corresponds to the mean irradiance. The escaped power of one iteration does
/// not, because that iteration also shoots light of the previous one. @return The mean.
RgbD merge_escaped_power(SolverState& state, const RgbD& escaped, const IterationPlan& plan);

/// Adds the rays of this iteration to the history. Elements created in it (index >= first_new) inherited a mean that is
/// too smooth, so only a share of their history counts (inherited_weight).
void update_history(SolverState& state, const IterationPlan& plan, std::uint32_t first_new);

}  // namespace interflect::inline detail
