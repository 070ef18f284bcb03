#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns the lowest patch of each patch's flat surface: patches in nearly one plane that share material, object and
/// whole edges, or have equal Patch::surface.
std::vector<std::uint32_t> flat_surfaces(const Scene& scene);

/// Returns a unique rank per patch. Patches are ordered by the area of their flat surface, which is counted once for
/// both sides; at nearly equal areas, emitters come first. Patches of one surface are ordered by index.
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene);
/// @param surface  Result of flat_surfaces().
std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene, const std::vector<std::uint32_t>& surface);

}  // namespace interflect::detail
