#pragma once

#include <string>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Scales the sources of a light group and all light that they bring, as if the scene had been solved so: no ray is
/// traced. Errors and importance stay what they were.
/// @param factor  1 is what they emit now; >= 0.
/// @throws InputError that lists the groups, where there is no such group; for a factor that is negative or not finite.
void dim(Scene& scene, Solution& solution, const std::string& group, float factor);

}  // namespace interflect
