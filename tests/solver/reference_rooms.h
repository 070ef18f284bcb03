#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve.h"
#include "tests/support/form_factors.h"

namespace interflect::testing_support {

/// A box of 1 x 2 x 3 m with 3 x 3 patches a wall, each wall with a colour and an exitance of its own. No two of its
/// patches see quite the same.
Scene colourful_box();

/// The same without the wall z = 3 m: much of the light leaves.
Scene open_colourful_box();

/// A furnished room of 78 + 8 patches: colourful walls, a box that stands free in it and hides walls from each other,
/// and a two-sided screen that emits a little.
Scene furnished_room();

/// Options under which the running mean has the exact solution as its expected value: the warm-up is so long that what
/// the last bounces lack is far below what a test can notice.
SolveOptions unbiased_options(PointSet points, std::uint64_t seed);

/// Root of the area-weighted mean square error of the luminance, over its area-weighted mean: what
/// IterationReport::error_estimate estimates.
double relative_error(const Scene& scene, const std::vector<Rgb>& irradiance, const std::vector<RgbD>& exact);

}  // namespace interflect::testing_support
