#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::command {

/// What a view meets first, as shares of the picture.
struct FirstMet {
    double nothing = 0;  ///< No face at all.
    double backs = 0;    ///< The back of a one-sided face, which lets rays through, whatever is seen behind it.
};

/// Traces 64 x 36 rays. @param aspect  Width over height of the picture.
FirstMet first_met(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

/// Logs where a camera seems to be outside the scene: most of its rays meet nothing, or the back of a face; of plans
/// and sections only where all meet nothing.
void warn_of_camera_outside(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

/// Logs why a picture is black: nothing emits, nothing is seen, or what is seen is unlit.
void warn_of_darkness(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

}  // namespace interflect::command
