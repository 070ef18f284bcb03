#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Edge of exactly one face.
struct OpenEdge {
    V3f a, b;  ///< Relative to Scene::origin [m].
    PatchIndex patch;
};

/// Returns the open edges, sorted by patch. Vertices at equal positions count as one.
std::vector<OpenEdge> open_edges(const Scene& scene);

}  // namespace interflect::detail
