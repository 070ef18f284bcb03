#pragma once

#include <memory>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// The images of a scene's environment maps, each once, in the order of the luminaires.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

}  // namespace interflect::inline detail
