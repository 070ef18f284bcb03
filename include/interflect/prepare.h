/// @file
/// Before solving: cuts faces at contacts, divides them, finds faults that would spoil the light, predicts the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect {

struct ContactOptions {
    /// Maximum distance of touching faces as a fraction of the smaller face's diameter. The rounding error of vertices
    /// always counts as touching.
    float touch_distance = 1e-4f;
    /// Minimum extent of connected segments [m], >= 0; smaller ones are ignored. Faces with less area than its
    /// square stay whole. Faces closer than half of it and 0.002 of the smaller one's diameter count as touching. Twice
    /// the side of the smallest elements is suitable. That side is 5 mm, at most a thousandth of the median side of the
    /// patches, weighted by their area.
    float min_extent = 0;
    /// Maximum ratio of length to width of quadrilateral pieces, >= 1. Longer pieces are divided across, unless
    /// narrower than twice `min_extent` or 0.002 of the face's diameter.
    float largest_aspect = 4;
    /// Maximum number of pieces of one face, in (0, 2^31). A face that needs more is cut along some segments only.
    std::uint32_t max_pieces_per_face = 1u << 16;
    /// Maximum number of patches of the resulting scene. Further faces stay whole.
    std::uint64_t max_patches = 50'000'000;
};

/// Cuts faces along the segments in which other faces meet them. No element then extends to both sides of a wall or is
/// partly covered. Segments are: an edge on the face (a wall or a leg on a floor); the intersection with a face that
/// passes through it; and the outline of a coplanar face that hides a part of it (paper on a desk). If two
/// faces are coplanar, the face of the larger flat surface is cut; a flat surface consists of faces in nearly one plane
/// that share material, object and whole edges. Contacts behind a one-sided face, segments on the face's own border and
/// intersections at less than one degree are ignored.
///
/// Each face is cut by a binary space partition in its plane: the line of a segment cuts the whole convex piece that
/// contains it. Pieces are triangles and convex quadrilaterals with the face's material, object, texture and lightmap
/// coordinates; they cover the face exactly (to the rounding of vertices). T-vertices may result. A warped
/// quadrilateral is cut as the two triangles of the ray caster.
///
/// Lengths below 4e-6 of the face's diameter, or below four roundings of its coordinates, are ignored. The result does
/// not depend on the order of faces or the number of threads.
/// @note Patch::surface identifies the original surface. Scene::contacts receives the parts of the cuts where other
///       faces meet the face.
/// @return       The scene, with a warning for each limit that was reached. Patches keep their order, with pieces in
///               place of their face. Cost: O(n log n + k) time for n faces and k pairs of touching faces.
/// @throws InputError for a scene with scene_faults().
Scene cut_at_contacts(const Scene& scene, const ContactOptions& options = {});

/// A problem of a scene that affects its light, or a note to consider before solving.
struct Finding {
    /// One occurrence; fields that do not apply are empty.
    struct Place {
        std::string object{}, material{};
        std::string where{};           ///< "file:line".
        Imath::V3d position{0, 0, 0};  ///< In world coordinates [m].
        bool has_position = false;
    };
    std::string kind;           ///< Stable identifier, such as "duplicate-face".
    bool is_problem = false;    ///< Whether it changes the light or is nearly certainly a mistake; otherwise a note.
    std::string message;        ///< Description in one sentence.
    std::string advice;         ///< Recommended action.
    std::int64_t count = 0;     ///< Number of occurrences.
    std::vector<Place> places;  ///< The first occurrences.
};

struct ValidateOptions {
    std::size_t places = 3;         ///< Maximum number of places listed per kind.
    float high_reflectance = 0.9f;  ///< Threshold above the reflectance of paints, paper and snow, in (0, 1).
};

/// Finds problems that would spoil a solution. Call it with the scene as read, before cut_at_contacts(). Problems:
/// "degenerate-face" (without area, omitted by the reader), "duplicate-face" (same corners as another), "inverted-face"
/// (one-sided, with the scene and its light behind it), "inverted-lamp" (its front is against a surface, its back is
/// not), "hidden-lamp" (covered, or enclosed by close surfaces), "open-lamp-back" (one-sided, close before a surface
/// that its reflected light reaches), "zero-power-lamp", "high-reflectance", "no-light", "implausible-size",
/// "maintenance-factor". Notes: "coincident-face" (partly covered by another in its plane), "open-edge" (belongs to one
/// face only) and "no-view"; then mistakes of placement, units and axes (validate_setup()). Surroundings of faces and
/// lamps are sampled with 64 rays a face, for at most 4096 faces of a kind.
/// @param ray_caster  Of this scene.
/// @return            In the order above. Cost: O(n log n) for n patches.
/// @throws InputError for a ray caster of another scene.
std::vector<Finding> validate(const Scene& scene, const RayCaster& ray_caster, const ValidateOptions& options = {});

/// Fast part of validate(), in milliseconds: probable mistakes in placement, units or axes. Problems: "close-luminaire"
/// (more than half of its light falls on a surface within 2 cm, or within a hundredth of a scene smaller than 2 m),
/// "outside-luminaire" (all of its light escapes; in a closed room, more than half of it, or rays in a quarter of all
/// directions), "wide-opening" (larger than the scene, or through its walls), "sunk-luminaire" (the upper half of its
/// opening is in a ceiling or wall), "enclosed-luminaire" (in a closed space without a view that is too narrow for a
/// room, or that keeps all light from the views) and "shut-out-sky" (a sky or a sun, and a closed scene seen from
/// inside). Notes: "mixed-photometry" (LM-63 and EULUMDAT in one scene), "probable-unit" and "probable-up-axis" (for
/// formats without either), and "contradicting-normals" (Scene::normals that deviate by 10 degrees or more from plane
/// faces, which ignore them). Traces 384 to 1280 rays for each point light, spot and measured light, and at most 64 x
/// 66 for its opening, for at most 1024 of them; 2^17 rays from views or points if a space is closed; and 2^14 lines to
/// find openings to the sky.
/// @return  In this order, the same for any number of threads. @throws InputError as validate() does.
std::vector<Finding> validate_setup(const Scene& scene, const RayCaster& ray_caster,
                                    const ValidateOptions& options = {});

/// Divides patches into grids, for methods without refinement. Triangles become n^2 triangles.
/// @param largest_edge  Maximum edge of the pieces [m], > 0.
/// @throws InputError above `max_patches`, for an invalid edge and a scene with faults.
Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches);

/// Returns an edge length for split_patches() [m]: 1/48 of the scene's diagonal, or more if it would make more than
/// about 200,000 patches.
float default_mesh_size(const Scene& scene);

/// Returns a minimum element side [m]: 5 mm, at most a thousandth of the area-weighted median patch side.
double default_element_size(const Scene& scene);

/// Axis that points up in a scene.
struct UpAxis {
    const char* axis;      ///< Such as "x", "-x" or "y".
    const char* evidence;  ///< "views" if it is nearly certain; "light" if it is a guess.

    V3f direction() const;  ///< Unit vector.
};

/// Returns the common up axis of the views, else the axis opposite to most emitted light, since most lamps hang.
/// @return  nullopt if neither exists.
std::optional<UpAxis> find_up_axis(const Scene& scene);

/// Peak memory of a run [bytes].
struct MemoryNeed {
    std::size_t scene = 0;
    std::size_t ray_tracer = 0;  ///< Includes coincident faces.
    std::size_t patches = 0;     ///< Memory of the solver for patches, without elements.
    std::size_t rest = 0;        ///< Memory of the program, threads and hits of camera rays.

    /// Memory of the solver's arrays for an element [bytes]. Measured: 98 to 109 for 0.7 to 3 million elements.
    std::size_t per_element = 128;

    /// Returns the sum of all parts except elements [bytes].
    std::size_t without_elements() const { return scene + ray_tracer + patches + rest; }
    /// Returns the memory for a number of elements, at least one per patch [bytes].
    std::size_t with(std::size_t elements) const { return without_elements() + elements * per_element; }
};

/// Predicts the memory of a run. Excludes links of method hr, 24 bytes each.
MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster);
/// Predicts the memory of a run with these options, including SolveOptions::keep_direct.
MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options);

/// Returns the number of elements that fit into a memory. @param bytes  Size of the memory [bytes].
/// @throws InputError with the required memory if the patches do not fit.
std::size_t elements_within(const MemoryNeed& need, std::size_t bytes, const Scene& scene);

/// First hits of a view's rays, as shares of the picture.
struct ViewCoverage {
    double nothing = 0;  ///< Rays without a hit.
    double backs = 0;    ///< Rays that first meet the back of a one-sided face, and pass through it.
};

/// Returns a view for a scene without views. The view from the corner, overview() of scene.h, is kept if it shows a lit
/// interior. Otherwise, the view is from a lit room. Eyes are rated by the share of lit surfaces and by their distance;
/// the best one looks where most of them are, from up to 4 m farther back. Without a lit room, the view from the corner
/// is replaced only if it shows no light. At most 128 eyes are sampled, above faces that face upwards, with 20 rays
/// each. A surface is lit if it emits or if a random path of at most six reflections finds a source or the sky.
/// @return  "overview", with the probable up axis of validate_setup(), else z; the same for any number of threads.
/// Cost: about 50,000 rays, and O(n) for n patches.
/// @throws InputError for a ray caster of another scene.
View overview(const Scene& scene, const RayCaster& ray_caster);

/// Traces a view's rays through 36 rows of pixels. From outside of a scene, most rays meet nothing or backs.
/// @param aspect  Width over height of the picture. @throws InputError for a view that defines no picture.
ViewCoverage view_coverage(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect);

}  // namespace interflect
