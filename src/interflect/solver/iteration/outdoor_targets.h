#pragma once

#include <cstdint>
#include <vector>

#include <ImathBox.h>

#include "interflect/ray_caster.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Line along which light from outside the scene would reach a surface.
struct OutdoorLine {
    Ray light;          ///< Starts at the surface point, in the direction of the light.
    std::uint32_t sun;  ///< Index of the sun, or none for sky light.
    double importance;  ///< Times the brightness: received power, weighted by importance.
};

/// Finds boxes in which lines converge, such as windows. At each place, every box is half as wide as the previous one.
/// A line belongs to the last box that it crosses. @param weights  One per line.
std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box);

/// Aims light from outside at places that are important to the views. Traces importance out of the scene, finds targets
/// (Emission) and estimates the importance of luminaire parts. Requires full importance and light from outside. @return
/// Number of rays traced.
std::int64_t aim_outdoor_light(SolverState& state);

}  // namespace interflect::detail
