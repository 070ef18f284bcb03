#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/sight_lines.h"
#include "interflect/validate.h"

namespace interflect::inline detail {

/// Findings about point lights, spots and measured lights: "close-luminaire", "outside-luminaire", "wide-opening" and
/// "mixed-photometry". Traces 256 rays a luminaire, by its intensities; of more than 1024 lights it samples 1024.
/// @param is_room  Of the scene's Shell.
std::vector<Finding> find_misplaced_lights(const Scene& scene, const SightLines& lines, bool is_room,
                                           std::size_t places);

}  // namespace interflect::inline detail
