#pragma once

#include <string>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Scales the sources of a light group and all of its light, without tracing rays; the result equals a solution of the
/// dimmed scene. Errors and importance are unchanged.
/// @param factor  Relative to the current emission; >= 0.
/// @throws InputError that lists the groups, for an unknown group; for a factor that is negative or not finite.
void dim(Scene& scene, Solution& solution, const std::string& group, float factor);

}  // namespace interflect
