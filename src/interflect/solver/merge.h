#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Eq. 6 with a tau for each element: what N rays brought, among the rays that its mean stands for so far. A patch has
/// the same tau as all others. Children made later have a larger one, but only for how they share what their parent
/// has: so none of the light is forgotten, and none counts twice. Where no element is younger than others this is
/// Eq. 6 as it is.
void merge(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const IterationPlan& plan);
void merge(const SolverState& state, std::vector<float>& mean, const std::vector<float>& received,
           const IterationPlan& plan);

/// The same for estimates that are not shot again: how siblings differ from their parent is averaged with a tau of
/// their own, but as differences, which may make an element's mean negative. So it stays unbiased, and its noise known,
/// where siblings are young and few rays have reached them.
void merge_details(const SolverState& state, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                   const IterationPlan& plan);

/// merge() and merge_details() for the parts that light groups bring; what is known of one that is dimmed to nothing
/// stays as it is.
void merge(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);
void merge_details(const SolverState& state, GroupLight& mean, const GroupLight& received, const IterationPlan& plan);

/// Eq. 6 for what an iteration lost through the openings of the scene: what escapes goes with what irradiance is the
/// mean of. That of one iteration does not, since it also shoots what the one before it left. @return The mean.
RgbD merge_escaped_power(SolverState& state, const RgbD& escaped, const IterationPlan& plan);

/// From now on the means stand for this iteration's rays too; for elements made in it, `first_new` and on, which
/// inherited a mean that is too smooth, less of them count.
void update_history(SolverState& state, const IterationPlan& plan, std::uint32_t first_new);

}  // namespace interflect::inline detail
