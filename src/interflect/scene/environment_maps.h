#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns each image once, in the order of the luminaires.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

/// Describes a fault in the number of skies or texels; empty if valid.
std::string sky_count_fault(const Scene& scene);

}  // namespace interflect::detail
