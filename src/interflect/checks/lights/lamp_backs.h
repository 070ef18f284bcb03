#pragma once

#include <cstddef>
#include <vector>

#include "interflect/checks/search/sight_lines.h"
#include "interflect/prepare.h"

namespace interflect::detail {

/// Finds "open-lamp-back" (docs/files/formats.md). Traces 32 rays behind an emitting face, and up to 1,600 if they hit
/// a close surface; for at most 512 faces.
std::vector<Finding> find_open_lamp_backs(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines,
                                          std::size_t places);

}  // namespace interflect::detail
