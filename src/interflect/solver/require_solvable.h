#pragma once

#include "interflect/solve.h"

namespace interflect::detail {

/// @throws InputError listing all options out of range and all faults of the scene.
void require_solvable(const Scene& scene, const SolveOptions& options);

}  // namespace interflect::detail
