#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns each image once, in luminaire order.
std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene);

/// Returns "" if the numbers of skies and texels are valid.
std::string sky_count_fault(const Scene& scene);

}  // namespace interflect::detail
