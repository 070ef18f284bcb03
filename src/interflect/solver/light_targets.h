#pragma once

#include <cstdint>
#include <vector>

#include <ImathBox.h>

#include "interflect/ray_caster.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Light from outside the scene that would reach a surface.
struct OutdoorLine {
    Ray light;          ///< From the surface point; the direction is the way of the light.
    std::uint32_t sun;  ///< Its number; none: the light comes from skies.
    double importance;  ///< Times the brightness there: power that arrives, weighed by importance.
};

/// At most so many places are aimed at, each with the same number of targets: enough to go from 10 km to 1 cm.
inline constexpr int most_places = 4, most_targets = 80;

/// Boxes, each half as wide as the one before it, in which lines come together: a window, a house, a place. Later ones
/// count for lines that cross several.
/// @param weights  Of the lines.
std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box);

/// Aims light from outside at the places that matter to the views: follows importance out of the scene, finds targets
/// (Emission) for the rays that escape, and estimates the importance of the parts. Does so only where a run follows
/// importance and has light from outside. @return The number of rays traced.
std::int64_t aim_outdoor_light(SolverState& state);

}  // namespace interflect::inline detail
