#pragma once

#include <ImathBox.h>

#include <vector>

#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/importance/neighbourhoods.h"
#include "interflect/solver/importance/view_importance.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/state/inputs.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Importance, random sequences and contributions of rays.
struct SamplingState {
    SamplingState(const RunInputs& inputs, const LightState& light);

    ViewImportance view;
    Neighbourhoods neighbourhoods;                // empty without a view
    std::vector<float> importance_at_start;       // indirect importance before the current iteration
    std::vector<PartImportance> part_importance;  // importance of luminaire parts for the current views
    SampleStreams streams;
    ContributionSums contributions;
    PayloadHistogram payloads;  // payloads of the last iteration
};

/// Evaluates the view importance of every element.
void set_view_importance(LightState& light, SamplingState& sampling);

/// Replaces the targets of outdoor light. Also resets the importance of luminaire parts.
void set_targets(RunInputs& inputs, SamplingState& sampling, std::vector<Imath::Box3f> targets);

}  // namespace interflect::detail
