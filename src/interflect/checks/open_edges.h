#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// An edge of exactly one face.
struct OpenEdge {
    V3f a, b;  ///< Relative to Scene::origin [m].
    std::uint32_t patch = none;
};

/// In order of the patches. Merges vertices at one position, regardless of texture coordinates. O(n log n).
std::vector<OpenEdge> open_edges(const Scene& scene);

}  // namespace interflect::detail
