#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Distinct images of a scene's environment maps, in the order of the luminaires.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

/// Fault in the number of skies or of the maps' texels, in words without a subject; empty if valid.
std::string sky_count_fault(const Scene& scene);

}  // namespace interflect::detail
