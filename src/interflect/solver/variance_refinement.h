#pragma once

#include "interflect/scene.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Splits every leaf within which irradiance is expected to vary by more than the noise that its children will have:
/// the variation is extrapolated from how the leaf and its siblings differ, beyond their noise (detail.h). Not where
/// that matters nothing to the error of the whole, nor below the smallest area (ElementFloor). New elements inherit
/// what their parents have; how they differ is measured by later rays alone, so it is not biased by the choice.
/// To be called between iterations.
void refine_by_variance(SolverState& state);

/// Leaves that reflect light where they receive it (StartPoints), one entry an element; empty unless
/// refine_by_variance() makes the mesh.
std::vector<std::uint8_t> leaves_that_blur(const SolverState& state);

}  // namespace interflect::inline detail
