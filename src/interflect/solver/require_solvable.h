#pragma once

#include "interflect/solve.h"

namespace interflect::detail {

/// @throws InputError listing all faults of the options and the scene.
void require_solvable(const Scene& scene, const SolveOptions& options);

}  // namespace interflect::detail
