#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::testing_support {

/// A method with options that make a variant of it.
struct Variant {
    std::string name;  ///< Letters, digits and underscores.
    SolveOptions options{.method = find_method("srr")};
};
std::ostream& operator<<(std::ostream& out, const Variant& variant);

/// Those that keep every ray, wdrs and hwdrs.
std::vector<Variant> variants_that_keep_every_ray();
/// Every method that averages iterations and all its variants: what is said of the mean over many seeds holds for each.
std::vector<Variant> stochastic_variants();
/// The stochastic methods of neither kind, as they are: each follows light to its end.
std::vector<Variant> variants_of_other_methods();
/// Those that importance drives.
std::vector<Variant> variants_with_importance();
/// Those that refine the mesh.
std::vector<Variant> variants_that_refine();

/// Importance-driven ones with options at the ends of their ranges.
std::vector<Variant> extreme_variants();

/// In a box of 1 x 2 x 3 m: sees parts of three walls, not the ceiling z = 3 m.
extern const View into_the_corner;

/// Smallest areas [m^2] by which a box of 1 x 2 x 3 m with 3 x 3 patches a wall is left whole, or divided once: its
/// patches have 2/9, 3/9 and 6/9 m^2.
inline constexpr double left_whole = 10, divided_once = 0.05;

/// Makes the oracle divide whatever light and importance reach, down to a smallest area [m^2].
void divide_everything(SolveOptions& options, double min_area);

/// Options under which the running means in that box, looked at into_the_corner, have the exact solution as their
/// expected value. The mesh is made in the warm-up and stays: every patch is divided once; left whole, where refinement
/// is deferred.
SolveOptions on_a_fixed_mesh(const Variant& variant, std::uint64_t seed);

/// The leaves in an order that depends on where they are alone: by patch and path.
std::vector<std::uint32_t> leaves_by_place(const ElementForest& forest);

/// The leaves of a forest over rectangles as the patches of a scene, in the order of leaves_by_place.
Scene scene_of_leaves(const Scene& scene, const ElementForest& forest);

}  // namespace interflect::testing_support
