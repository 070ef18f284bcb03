#pragma once

#include <cstdint>

#include "interflect/scene.h"
#include "tests/support/form_factors.h"

namespace interflect::testing_support {

/// Estimates form factors with occlusion, from `rays_per_patch` rays out of each patch. Independent of the library:
/// double precision, its own intersection test and random numbers, and another sampling of directions. The scene has
/// only rectangles; their backs transmit rays. A value F has the standard error sqrt(F (1 - F) / rays_per_patch).
FormFactors traced_form_factors(const Scene& scene, std::int64_t rays_per_patch, std::uint64_t seed);

}  // namespace interflect::testing_support
