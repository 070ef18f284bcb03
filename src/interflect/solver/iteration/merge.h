#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Merges a step by Eq. 6, Prikryl et al. 2000: mean += tau (received - mean), with tau = N / (history + N) per element
/// and N rays. Children with a larger tau only redistribute their parent's mean, which preserves power.
void merge(const LightState& light, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
           const TracedIteration& iteration);
/// Merges the indirect importance in the same way.
void merge_importance(LightState& light, const RayTotals& rays, const std::vector<float>& received,
                      const TracedIteration& iteration);

/// Merges an independent estimate (docs/method/method.md, A run). The resulting means may be negative.
void merge_independent(const LightState& light, std::vector<Rgb>& mean, const std::vector<Rgb>& received,
                       const TracedIteration& iteration);

/// Merge every light group. Groups that are dimmed to 0 do not change.
void merge(const LightState& light, GroupLight& mean, const GroupLight& received, const TracedIteration& iteration);
void merge_independent(const LightState& light, GroupLight& mean, const GroupLight& received,
                       const TracedIteration& iteration);

void merge_escaped_power(LightState& light, const RgbD& escaped, const TracedIteration& iteration);

/// Adds the rays of an iteration. New elements keep only `inherited_weight` of their history.
void update_history(LightState& light, const TracedIteration& iteration);

}  // namespace interflect::detail
