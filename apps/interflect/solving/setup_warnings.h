#pragma once

#include <string>

#include "interflect/prepare.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Returns "object 'lamp', 'bulb', at (1, 2, 0.5)"; equal names once.
std::string text_of(const Finding::Place& place);

/// Returns a finding's advice and the command's option for it.
std::string remedy(const Finding& finding);

/// Logs each finding of validate_setup().
void warn_of_setup(const Scene& scene, const RayCaster& ray_caster);

}  // namespace interflect::command
