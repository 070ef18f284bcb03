#pragma once

#include <string>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/validate.h"

namespace interflect::command {

/// "object 'lamp', 'bulb' at (1, 2, 0.5)".
std::string text_of(const Finding::Place& place);

/// A finding's advice, followed by the option of the command for it.
std::string remedy(const Finding& finding);

/// Logs a line for each finding of validate_setup().
void warn_of_setup(const Scene& scene, const RayCaster& ray_caster);

}  // namespace interflect::command
