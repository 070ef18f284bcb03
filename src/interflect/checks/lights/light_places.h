#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/lights/local_lights.h"
#include "interflect/checks/search/shell.h"
#include "interflect/checks/search/sight_lines.h"
#include "interflect/prepare.h"

namespace interflect::detail {

/// Finds "close-luminaire", "outside-luminaire", "wide-opening", "sunk-luminaire", "mixed-photometry"
/// (docs/files/formats.md).
std::vector<Finding> find_misplaced_lights(const Scene& scene, const LocalLights& lights, const SightLines& lines,
                                           const Shell& shell, std::size_t places);

}  // namespace interflect::detail
