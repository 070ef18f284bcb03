#pragma once

#include "interflect/checks/search/sight_lines.h"

namespace interflect::detail {

/// Enclosed space, sampled with random lines from outside.
struct Shell {
    /// Nine of ten lines reach an inner side that few rays leave: true with a window, false with a missing wall.
    bool is_closed = false;
    /// Closed, with a view inside or, without views, 2 m wide in each direction.
    bool is_room = false;
    float mean_free_path = 0;  ///< Between inner sides [m]; 0 unless closed.
};

/// Traces at most 128 x 98 rays.
Shell find_shell(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines);

/// Whether any of 2^14 lines from outside reaches an inner side. Finds 1 m^2 of windows in 1000 m^2 of hull with
/// probability above 0.998.
bool has_opening(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines);

}  // namespace interflect::detail
