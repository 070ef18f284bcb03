#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/local_lights.h"
#include "interflect/checks/sight_lines.h"
#include "interflect/prepare.h"

namespace interflect::detail {

/// Finds "enclosed-luminaire" among point lights, spots and measured lights: no light of 8 to 64 paths of 16 segments,
/// reflected independently of reflectance, leaves the scene, and no view lies in the space that the paths reach. That
/// space is also too narrow for a room, or the rest of the scene is dark:
/// - It is at most 0.5 m across and a tenth of the scene, or less than 0.5 m in one direction in a scene of at least 2
/// m
///   in each direction, such as the plenum above a ceiling.
/// - No light of any source reaches a view inside the scene. Without such views, it reaches less than an eighth of the
///   enclosed volume.
/// Closed rooms with lamps of their own are sound. Traces at most 2^17 rays for the luminaires, and 2^17 for views or
/// points in the volume.
std::vector<Finding> find_enclosed_lights(const Scene& scene, const RayCaster& ray_caster, const LocalLights& lights,
                                          const SightLines& lines, std::size_t places);

}  // namespace interflect::detail
