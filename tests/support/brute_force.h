#pragma once

#include <cstdint>

#include "interflect/scene.h"
#include "tests/support/form_factors.h"

namespace interflect::testing_support {

/// Form factors with occlusion, from `rays_per_patch` rays out of each patch. Shares nothing with the library: double
/// precision, its own ray/rectangle intersection, its own random numbers, directions by another method. The scene has
/// only rectangles; a back lets rays through. A value F has the standard error sqrt(F (1 - F) / rays_per_patch).
FormFactors traced_form_factors(const Scene& scene, std::int64_t rays_per_patch, std::uint64_t seed);

}  // namespace interflect::testing_support
