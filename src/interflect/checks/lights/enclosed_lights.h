#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/lights/local_lights.h"
#include "interflect/checks/search/sight_lines.h"
#include "interflect/prepare.h"

namespace interflect::detail {

/// Finds "enclosed-luminaire" (docs/files/formats.md). Traces at most 2^18 rays.
std::vector<Finding> find_enclosed_lights(const Scene& scene, const RayCaster& ray_caster, const LocalLights& lights,
                                          const SightLines& lines, std::size_t places);

}  // namespace interflect::detail
