#pragma once

#include "interflect/scene.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Splits every leaf in which irradiance is expected to vary by more than the noise of its children. The variation is
/// extrapolated from the differences between the leaf and its siblings, less their noise (detail.h). Leaves with a
/// negligible share of the total error, and the smallest elements (ElementFloor), are not split. New elements inherit
/// from their parents. Only later rays measure their differences, so the choice does not bias them. Call between
/// iterations.
void refine_by_variance(SolverState& state);

/// Marks leaves that reflect light where they receive it (StartPoints), one entry per element. Empty unless
/// refine_by_variance() makes the mesh.
std::vector<std::uint8_t> leaves_that_blur(const SolverState& state);

}  // namespace interflect::inline detail
