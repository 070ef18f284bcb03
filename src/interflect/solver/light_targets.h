#pragma once

#include <cstdint>
#include <vector>

#include <ImathBox.h>

#include "interflect/ray_caster.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Light from outside the scene that would reach a surface.
struct OutdoorLine {
    Ray light;          ///< Starts where importance does; the direction is that of light.
    std::uint32_t sun;  ///< That it comes from; none: skies.
    double importance;  ///< Times the brightness there: power that arrives, weighed by importance.
};

/// At most so many places are aimed at, each with the same number of targets: enough to go from 10 km to 1 cm.
inline constexpr int most_places = 4, most_targets = 80;

/// Boxes, each half as wide as the one before it, in which lines come together: a window, a house, a place. Later ones
/// count for lines that cross several.
/// @param weights  Of the lines.
std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box);

/// Lets light from outside be shot where it matters to the views: follows importance out of the scene, finds targets
/// (Emission) for what escapes, and what each of the luminaires' parts is worth. Nothing where no light is from
/// outside, or no importance is followed. @return Rays that it has traced.
std::int64_t aim_outdoor_light(SolverState& state);

}  // namespace interflect::inline detail
