#pragma once

#include <string>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/validate.h"

namespace interflect::command {

/// "object 'lamp', 'bulb' at (1, 2, 0.5)".
std::string text_of(const Finding::Place& place);

/// What to do about a finding, with the option of the command that does it.
std::string remedy(const Finding& finding);

/// Logs a line for each finding of validate_setup().
void warn_of_setup(const Scene& scene, const RayCaster& ray_caster);

}  // namespace interflect::command
