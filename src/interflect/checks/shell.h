#pragma once

#include "interflect/checks/sight_lines.h"

namespace interflect::detail {

/// Enclosed space of a scene, sampled with random lines from outside.
struct Shell {
    /// Whether nine of ten lines from outside reach an inner side: one from which at most 2 of 32 rays leave the scene.
    /// It belongs to the first face on the line or, behind the outer side of a thick wall of one-sided faces, to the
    /// second. Lines through such walls alone do not count, but may be at most half of all. True for a room with a
    /// window, false for a room with a missing wall.
    bool is_closed = false;
    /// Whether the shell is closed and seen from inside: a view is inside, or the scene has no view and is at least 2 m
    /// in each direction. Closed solids seen from outside are no rooms.
    bool is_room = false;
    float mean_free_path = 0;  ///< Mean length of rays between inner sides [m]; 0 unless closed.
};

/// Traces at most 128 lines, and 1 + 3 x 32 rays a line.
Shell find_shell(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines);

/// Whether at least one of 2^14 lines from outside reaches an inner side. Finds windows of 1 m^2 in a building with
/// 1000 m^2 of walls and roof with a probability above 0.998.
bool lets_light_in(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines);

}  // namespace interflect::detail
