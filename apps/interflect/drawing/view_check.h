#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Warns if a camera seems to be outside the scene: most rays miss, or meet a back first. For plans and sections, all
/// rays must miss.
void warn_of_camera_outside(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

/// Warns that a picture is black and says why: no light is emitted, no surface is visible, or surfaces are unlit.
void warn_of_darkness(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

}  // namespace interflect::command
