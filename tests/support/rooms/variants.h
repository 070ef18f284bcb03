#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::testing_support {

struct Variant {
    std::string name;  ///< Letters, digits and underscores.
    SolveOptions options{.method = find_method("srr")};
};
std::ostream& operator<<(std::ostream& out, const Variant& variant);

/// Returns wdrs, hwdrs and ihwdrs.
std::vector<Variant> variants_that_keep_every_ray();
/// Returns srr, isrr, hsrr and ihsrr, with the variants of the paper. Statements about the mean over many seeds apply
/// to each.
std::vector<Variant> stochastic_variants();
/// Returns the stochastic methods of neither kind, without options. Each traces light to its end.
std::vector<Variant> variants_of_other_methods();
std::vector<Variant> variants_with_importance();

/// Returns importance-driven variants with options at the ends of their ranges.
std::vector<Variant> extreme_variants();

/// View in a box of 1 x 2 x 3 m: shows parts of three walls, but not the ceiling z = 3 m.
extern const View into_the_corner;

/// Smallest areas [m^2] for which a box of 1 x 2 x 3 m with 3 x 3 patches per wall stays undivided or is divided once:
/// its patches have 2/9, 3/9 and 6/9 m^2.
inline constexpr double left_whole = 10, divided_once = 0.05;

/// Makes the oracle divide all elements that receive light or importance, down to a smallest area [m^2].
void divide_everything(SolveOptions& options, double min_area);

/// Returns options for which the running means in that box have the exact solution as their expected value, with the
/// view into_the_corner. The mesh is made in the warm-up and then fixed. Every patch is divided once, or not at all if
/// refinement is deferred.
SolveOptions on_a_fixed_mesh(const Variant& variant, std::uint64_t seed);

/// Returns the leaves ordered by patch and path, independent of the order of their creation.
std::vector<ElementIndex> leaves_by_place(const detail::ElementForest& forest);

/// Returns a scene whose patches are the leaves of a forest over rectangles, in the order of leaves_by_place.
Scene scene_of_leaves(const Scene& scene, const detail::ElementForest& forest);

}  // namespace interflect::testing_support
