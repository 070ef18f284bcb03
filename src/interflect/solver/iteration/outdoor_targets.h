#pragma once

#include <cstdint>
#include <vector>

#include <ImathBox.h>

#include "interflect/ray_caster.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// A line from a surface point to a sky or sun.
struct OutdoorLine {
    Ray light;          ///< Starts at the surface point, in the direction in which light travels.
    std::uint32_t sun;  ///< Index of the sun; `none` for skies.
    double importance;  ///< Importance-weighted power per PartAlong::brightness.
};

/// Finds nested boxes around places where weighted lines converge, such as windows.
std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box);

/// Sets the targets of outdoor light and the importance of its parts. Does nothing without full importance or outdoor
/// light.
/// @return  Lines of outdoor light to important surfaces.
std::vector<OutdoorLine> aim_outdoor_light(SolverState& state);

}  // namespace interflect::detail
