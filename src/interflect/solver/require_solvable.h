#pragma once

#include "interflect/solve_options.h"

namespace interflect::detail {

/// @throws InputError listing all faults.
void require_solvable(const Scene& scene, const SolveOptions& options);

}  // namespace interflect::detail
