#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Excludes patches covered by coincident faces, dark sides of faces and encased_patches() from export. A face dark on
/// both sides keeps its first. Uses undimmed light: all states of a solution export the same patches.
std::vector<bool> shown_patches(const Scene& scene, const Solution& solution);

}  // namespace interflect::detail
