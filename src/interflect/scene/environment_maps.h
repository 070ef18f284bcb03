#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Each once, in the order of the luminaires.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

/// "" if the numbers of skies and texels are valid.
std::string sky_count_fault(const Scene& scene);

}  // namespace interflect::detail
