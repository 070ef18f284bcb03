#pragma once

#include "interflect/solve.h"

namespace interflect::inline detail {

/// @throws InputError that lists every option out of range and every fault of the scene.
void require_solvable(const Scene& scene, const SolveOptions& options);

}  // namespace interflect::inline detail
