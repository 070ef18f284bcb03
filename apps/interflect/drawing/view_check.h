#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Warns if a camera seems to be outside the scene, because most rays miss it or meet the back of a face first. Warns
/// about plans and sections only if all rays miss.
/// @param aspect  Width over height of the picture.
void warn_of_camera_outside(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

/// Warns that a picture is black, with the reason: no light is emitted, no surface is visible, or surfaces are unlit.
/// @param aspect  Width over height of the picture.
void warn_of_darkness(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

}  // namespace interflect::command
