/// @file
/// View factors (form factors) between groups of patches, by ray casting: docs/method/view-factors.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect {

/// Patches that exchange radiation as one surface.
struct FaceGroup {
    std::string name;
    std::vector<PatchIndex> patches;  ///< Indices into Scene::patches, each at most once.
};

/// Appends a black back without names for every one-sided face, so that it blocks from both sides. Otherwise rays pass
/// through it from behind, visibility is not symmetric, and reciprocity fails. Existing patches keep their indices, and
/// have priority over coincident backs.
Scene with_opaque_backs(const Scene& scene);

/// Sides of two-sided faces that belong to groups; the others only block. One-sided faces always belong.
enum class FaceSides {
    both,
    front,  ///< The side in the file, from which the vertices are counter-clockwise.
    back,
};

/// Returns a group for each patch that has a named object or material, in the order of the scene. The names are
/// "object:index" or "index".
std::vector<FaceGroup> facet_groups(const Scene& scene, FaceSides sides = FaceSides::both);
/// Returns a group for each named object that has patches, in the order of Scene::objects. Nested objects are separate
/// groups; patches without an object belong to no group.
std::vector<FaceGroup> object_groups(const Scene& scene, FaceSides sides = FaceSides::both);
/// Returns a group for each named material that has patches, in the order of Scene::materials.
std::vector<FaceGroup> material_groups(const Scene& scene, FaceSides sides = FaceSides::both);

/// Returns object_groups(), or material_groups() if no object with patches has a name.
std::vector<FaceGroup> named_groups(const Scene& scene, FaceSides sides = FaceSides::both);

/// A group by the names of its objects or materials.
struct FacePattern {
    std::string name;
    std::string pattern;  ///< As LightGroup::pattern.
};
/// Returns a group for each pattern. A patch belongs to the first pattern that matches its object or material, if any.
/// @throws InputError for a pattern without patches, an empty name or pattern, and a repeated name.
std::vector<FaceGroup> pattern_groups(const Scene& scene, std::span<const FacePattern> patterns,
                                      FaceSides sides = FaceSides::both);

struct ViewFactorOptions {
    /// Rays in total, > 0. Every group has the same number: the largest power of two within this total, but at least
    /// 1024 and at most 2^36.
    std::int64_t rays = 20'000'000;
    std::uint64_t seed = 1;  ///< The same seed gives the same bits for any number of threads.
};

/// View factors F_ij = values of row i and column j: the fraction of the diffuse radiation that leaves group i and
/// reaches group j directly. A sparse matrix in compressed rows, whose arrays SciPy's csr_matrix accepts.
struct ViewFactors {
    std::vector<std::string> names;         ///< Names of the groups.
    std::vector<double> areas;              ///< Uncovered area of each group [m^2].
    std::vector<std::int64_t> row_offsets;  ///< Start of each row in the next three arrays, and the end.
    std::vector<std::int32_t> columns;      ///< Increasing within a row.
    std::vector<float> values;              ///< In [0, 1].
    std::vector<float> errors;              ///< Standard errors. Absent entries have 1 / rays_per_group.
    /// Fractions that leave the scene above and below the horizon (the direction's z > 0 and < 0): the sky view factor,
    /// and its counterpart for the ground of a scene without one.
    std::vector<float> sky, sky_errors, ground, ground_errors;
    std::vector<float> blocked, blocked_errors;  ///< Fraction that reaches patches of no group.
    std::int64_t rays_per_group = 0;

    std::size_t size() const { return areas.size(); }
    /// One hit in all rays of a group: the resolution of a factor.
    double smallest_error() const { return 1 / static_cast<double>(rays_per_group); }
    /// F_ij and its standard error. O(log of the row's length).
    struct Factor {
        double value = 0, error = 0;
    };
    Factor factor(std::size_t i, std::size_t j) const;
    /// Sum of a row, with sky, ground and blocked: 1, unless the group has no uncovered area.
    double closure(std::size_t i) const;
};

/// Estimates all view factors. The rays of a group start uniformly on its uncovered area, with density cos(theta) / pi,
/// at Owen-scrambled Sobol' points. Their hits are counted; all surfaces are opaque, and black for this purpose.
/// Rays pass through the back of one-sided faces, as for RayCaster, unless with_opaque_backs() made the scene.
///
/// Standard errors result from 32 independent scramblings of each group's points: sqrt(S + 1) / N for N rays and the
/// variance S of the number of hits. The 1 is the resolution of a count, and covers a chance S = 0.
///
/// A group without uncovered area has an area of 0 and an empty row.
/// @param groups      Without common patches, at most 2^31 - 4.
/// @param ray_caster  Of this scene.
/// @throws InputError for groups with common or missing patches, a number of rays out of range and a ray caster of
///         another scene; Stopped.
/// Cost: O(rays log(patches)); 12 bytes per non-zero factor.
ViewFactors view_factors(const Scene& scene, const RayCaster& ray_caster, std::span<const FaceGroup> groups,
                         const ViewFactorOptions& options = {}, const Monitor& monitor = {});
/// The same for with_opaque_backs(scene), with its own ray caster: both sides of all faces block.
ViewFactors view_factors(const Scene& scene, std::span<const FaceGroup> groups, const ViewFactorOptions& options = {},
                         const Monitor& monitor = {});

/// Deviations from a law that exact factors obey.
struct Deviation {
    double largest = 0, rms = 0;
    double largest_in_errors = 0, rms_in_errors = 0;  ///< Divided by the standard error of each.
};

struct Consistency {
    /// closure(i) - 1. Zero to rounding for view_factors(), which counts every ray once.
    Deviation closure;
    /// (A_i F_ij - A_j F_ji) / min(A_i, A_j), over pairs with a non-zero factor: relative to the largest possible
    /// A_i F_ij.
    Deviation reciprocity;
};
/// O(number of non-zero factors).
Consistency consistency(const ViewFactors& factors);

struct ReconcileOptions {
    bool closure = true, reciprocity = true;  ///< Laws to enforce.
};

struct Reconciliation {
    Consistency before, after;
    int solves = 0, iterations = 0;  ///< Number of linear systems and of all steps of conjugate gradients.
};

/// Replaces factors by the nearest that obey reciprocity and closure and are non-negative: weighted least squares,
/// weights from the standard errors (after Larsen and Howell 1986; Lawson 1995; Taylor and Luck 1995). Both directions
/// of a pair are first averaged, with weights 1 / (A_i (1 - F_ij)). Sky, ground and blocked are further columns; zero
/// columns and pairs without any hit stay zero.
///
/// Afterwards reciprocity holds to 2^-22 of each factor and closure to 1e-6, if the laws are compatible. Two surfaces
/// of different areas that see only each other are not, for example; `after` then reports the rest.
///
/// The errors become the errors of the averages of both directions. The fit usually reduces them further.
/// Memory: at most 24 bytes per non-zero factor in addition.
/// @throws Stopped, and then leaves the factors as they were.
Reconciliation reconcile(ViewFactors& factors, const ReconcileOptions& options = {}, const Monitor& monitor = {});

}  // namespace interflect
