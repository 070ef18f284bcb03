#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The images of a scene's environment maps, each once, in the order of the luminaires.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

/// What is wrong with the number of a scene's domes and maps, or of the maps' texels, in words without a subject; empty
/// where nothing is.
std::string sky_count_fault(const Scene& scene);

}  // namespace interflect::inline detail
