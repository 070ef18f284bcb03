#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

struct PatchVisibility {
    std::vector<float> light;   ///< Undimmed light by patch_light() [lm/m^2].
    std::vector<bool> lit;      ///< Patches with more than stray light.
    std::vector<bool> encased;  ///< Result of encased_patches().
    std::vector<bool> hidden;   ///< Patches covered by coincident faces, and encased ones.
};

PatchVisibility patch_visibility(const Scene& scene, const Solution& solution);

/// Returns which patches are exported: all except patches covered by coincident faces, dark sides of faces, and
/// encased_patches(). If both sides of a face are dark, the first is exported. The light is undimmed, so that all
/// states of dimming export the same patches.
std::vector<bool> shown_patches(const Scene& scene, const Solution& solution);

}  // namespace interflect::detail
