#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve.h"
#include "tests/support/form_factors.h"

namespace interflect::testing_support {

/// Returns a box of 1 x 2 x 3 m with 3 x 3 patches per wall. Each wall has its own colour and exitance. No two patches
/// have quite the same surroundings.
Scene colourful_box();

/// Returns the same box without the wall z = 3 m, through which much of the light escapes.
Scene open_colourful_box();

/// Returns a furnished room of 78 + 8 patches: colourful walls, a free-standing box that occludes walls from each
/// other, and a two-sided screen that emits a little.
Scene furnished_room();

/// Returns options for which the running mean has the exact solution as its expected value. The light that the long
/// warm-up misses is far below the sensitivity of the tests.
SolveOptions unbiased_options(PointSet points, std::uint64_t seed);

/// Returns the root of the area-weighted mean square error of the luminance, relative to its area-weighted mean.
/// IterationReport::error_estimate estimates this value.
double relative_error(const Scene& scene, const std::vector<Rgb>& irradiance, const std::vector<RgbD>& exact);

}  // namespace interflect::testing_support
