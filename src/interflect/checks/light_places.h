#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/sight_lines.h"
#include "interflect/validate.h"

namespace interflect::inline detail {

/// Finds "close-luminaire", "outside-luminaire", "wide-opening" and "mixed-photometry" among point lights, spots and
/// measured lights. Traces 256 rays per luminaire, distributed by its intensities, for at most 1024 luminaires.
/// @param is_room  Shell::is_room of the scene.
std::vector<Finding> find_misplaced_lights(const Scene& scene, const SightLines& lines, bool is_room,
                                           std::size_t places);

}  // namespace interflect::inline detail
