#pragma once

#include <algorithm>
#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

inline std::uint32_t back_material(const Scene& scene, const Patch& patch) {
    return patch.other_side == no_patch ? none : scene.patches[patch.other_side].material;
}

/// Adds the front of a face and, unless `back_material` is none, its back with reversed vertices.
inline void add_face(Scene& scene, Patch patch, std::uint32_t back_material) {
    const PatchIndex index(scene.patches.size());
    patch.other_side = back_material == none ? no_patch : index + 1;
    scene.patches.push_back(patch);
    if (back_material == none) return;
    patch.material = back_material;
    patch.other_side = index;
    std::reverse(patch.vertices.begin() + 1, patch.vertices.begin() + patch.vertex_count());
    scene.patches.push_back(patch);
}

}  // namespace interflect::detail
