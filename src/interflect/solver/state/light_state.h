#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solution.h"
#include "interflect/solver/light/group_light.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/noise/history.h"
#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/state/inputs.h"

namespace interflect::detail {

/// The mesh, the light on it, and the errors of this light.
struct LightState {
    LightState(const RunInputs& inputs, const SolveOptions& options);

    const SolveOptions& options() const { return solution.options; }

    const std::shared_ptr<ElementForest> forest;
    Solution solution;
    History history;
    NoiseModel noise;
    RiskCheck risk_check;
    RgbD escaped_power{0, 0, 0};    // mean escaped power, averaged like irradiance [lm or W]
    double escaped_power_rays = 0;  // number of rays in this mean
    double discarded_hits = 0;      // see IterationReport
};

/// Replaces the sources. @param lit  Scene with the new sources; must outlive the inputs.
void set_sources(RunInputs& inputs, LightState& light, const Scene& lit);

/// Returns the radiosity of each light group. It refers to the arguments.
GroupRadiosity group_radiosity(const RunInputs& inputs, const LightState& light, const GroupLight& irradiance,
                               bool emits = true);

/// Returns the power of surfaces and luminaires [lm or W].
RgbD radiated_power(const RunInputs& inputs, const LightState& light);

bool refines_by_variance(const SolveOptions& options);

/// Evaluate ElementFloor for an element [m^2].
float min_area(const RunInputs& inputs, const LightState& light, ElementIndex element);
float pixel_area(const RunInputs& inputs, const LightState& light, ElementIndex element);

}  // namespace interflect::detail
