/// @file
/// The scene: patches, materials, textures, views, light sources and light groups.
#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/core.h"
#include "interflect/indices.h"
#include "interflect/light_sources.h"

namespace interflect {

/// Texture coordinates (u, v): (0, 0) is the lower left corner of the image, (1, 1) the upper right. The image repeats.
using V2f = Imath::V2f;

/// An image that multiplies a material's reflectance, exitance or transmittance.
struct Texture {
    std::string name;  ///< Source file.
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> texels;  ///< Linear Rec. 709, >= 0, row by row, row 0 at the top: [y * width + x].
};

/// Limits: texels of all textures of a scene, 12 bytes each; texels along the side of an image.
inline constexpr std::uint64_t max_texels = std::uint64_t{1} << 26;
inline constexpr std::uint32_t max_texels_of_side = 1u << 14;

/// Largest texture coordinate. Single precision resolves 1 / 2000 texel there.
inline constexpr float farthest_texture_coordinate = 4096;

/// Returns the texture at (u, v), by bilinear interpolation between texel centres.
Rgb texel_at(const Texture& texture, const V2f& coordinate);

/// Returns the maximum of each channel, which is an upper bound of the interpolated texture.
Rgb largest_texel(const Texture& texture);

/// Fault of a texture (its size, a texel that is negative or not finite), in words without a subject; empty if valid.
std::string texture_fault(const Texture& texture);

/// Fault of texture coordinates, in the same form.
std::string texture_coordinate_fault(const V2f& coordinate);

struct Scene;

/// Light sources that are dimmed together.
struct LightGroup {
    std::string name;
    /// Pattern of the names of objects, materials or luminaires: '*' matches any characters, '?' one. An object
    /// includes nested objects ("lamps" includes "lamps.left").
    std::string pattern;
};

/// Maximum number of groups, including that of unmatched sources.
inline constexpr std::size_t max_light_groups = 32;

/// Returns whether a pattern matches all of `name`. Cost: O(product of both lengths).
bool matches(std::string_view pattern, std::string_view name);
/// Returns whether a pattern matches the name of an object, such as "room.desk.leg", or of an enclosing object, "room"
/// or "room.desk".
bool matches_object(std::string_view pattern, std::string_view name);

/// Group of each light source, which is the first group whose pattern matches.
struct SourceGroups {
    std::vector<std::string> names;          ///< Names of Scene::light_groups, then "other" if a source matches none.
    std::vector<std::uint8_t> of_patch;      ///< Index into names; undefined for patches that do not emit.
    std::vector<std::uint8_t> of_luminaire;  ///< Index into names.

    bool empty() const { return names.empty(); }
    std::size_t size() const { return names.size(); }
    /// @throws InputError that lists the names, for an unknown group.
    std::size_t index_of(const std::string& name) const;
};

/// Returns the group of each source; empty for a scene without groups.
/// @throws InputError for more than max_light_groups or a duplicate name.
SourceGroups source_groups(const Scene& scene);

/// Requires that each group has sources. @throws InputError for a group without sources, and as source_groups() does.
void require_sources_of_groups(const Scene& scene);

/// Returns a group for each top-level object that has sources. If at most one object has sources, returns a group for
/// each emitting material and each luminaire. @throws InputError for more than max_light_groups.
std::vector<LightGroup> groups_by_name(const Scene& scene);

/// Returns a copy of the scene with the sources of each group scaled. Materials keep their order.
/// @param factors  One per group of source_groups(scene); >= 0.
Scene dimmed(const Scene& scene, const SourceGroups& groups, const std::vector<float>& factors);

/// Material of a surface; the same on both sides of a two-sided face.
struct Material {
    std::string name;
    Rgb reflectance{0, 0, 0};  ///< Diffuse reflectance rho, each channel in [0, 1).
    Rgb exitance{0, 0, 0};     ///< Self-emitted exitance M [lm/m^2 or W/m^2], >= 0.
    /// Textures that multiply the reflectance and the exitance (indices into Scene::textures, or none). The products
    /// obey the limits above.
    std::uint32_t reflectance_texture = none, exitance_texture = none;
    /// Fraction of light that passes straight through: thin glass, or with a texture the holes of a leaf or a fence.
    /// The sum with both reflectances is at most 1.
    Rgb transmittance{0, 0, 0};
    std::uint32_t transmittance_texture = none;  ///< Multiplies the transmittance.
    /// Mirrored fraction of light. The camera sees it in gathered and path-traced pictures; the solver loses it.
    Rgb specular_reflectance{0, 0, 0};

    bool is_textured() const {
        return reflectance_texture != none || exitance_texture != none || transmittance_texture != none;
    }
};

/// One side of an input polygon: a triangle or a convex quadrilateral, planar within 2e-6 of its largest coordinate.
/// More warp increases the ray offset, which prevents leaks but reduces accuracy near the edges. Two triangles are
/// exact.
struct Patch {
    /// Counter-clockwise seen from the lit side; [3] == none for a triangle.
    std::array<std::uint32_t, 4> vertices{none, none, none, none};
    std::uint32_t material = 0;
    PatchIndex other_side{};   ///< Patch on the back of the face; none if one-sided.
    std::uint32_t object = 0;  ///< Index into Scene::objects.
    /// Number of the flat surface that contains the patch, if cut_at_contacts() cut its faces; none: the surface is
    /// derived from whole edges.
    std::uint32_t surface = none;

    bool is_triangle() const { return vertices[3] == none; }
    int vertex_count() const { return is_triangle() ? 3 : 4; }
};

/// Segment along which a face was cut where another face meets it. Light differs on its two sides.
struct Contact {
    V3f a, b;  ///< Ends [m]; on edges of the pieces.
};

/// A pinhole camera in world coordinates.
struct View {
    std::string name;
    Imath::V3d eye{0, 0, 0};      ///< Position of the camera [m].
    Imath::V3d look_at{0, 1, 0};  ///< Point in the centre of the picture [m].
    V3f up{0, 0, 1};              ///< Need not be normalised or perpendicular to the view direction.
    float fov = 45;               ///< Vertical, full [degrees], in (0, 180).
    /// Above 0: orthographic, height of the picture [m]; `fov` is ignored. Rays start on the plane through the eye,
    /// which cuts the scene: plans and sections. Do not solve with such a view.
    float extent = 0;

    bool operator==(const View&) const = default;
};

/// Scene in metres and linear Rec. 709; immutable once loaded. The patches of a two-sided face are adjacent, the side
/// in the file first.
struct Scene {
    std::string name;  ///< Source file.
    /// World coordinates of the vertices' origin [m]. Readers choose it to preserve precision: 0, or near the middle of
    /// a scene that is farther than about 8 of its radii from 0.
    Imath::V3d origin{0, 0, 0};
    std::vector<V3f> vertices;  ///< Relative to `origin` [m]. Unused vertices are ignored.
    /// (u, v) of every vertex, or empty if no patch is textured.
    std::vector<V2f> texture_coordinates;
    /// (u, v) in [0, 1] of every vertex in its object's own lightmap, if the file provides one (TEXCOORD_1 of glTF);
    /// (0, 0) is the lower left corner. Empty if no vertex has any. The corners of a patch all have coordinates or are
    /// all NaN.
    std::vector<V2f> lightmap_coordinates;
    /// Unit normal of the smooth surface at every vertex, as the file has it (glTF NORMAL, OBJ vn, PLY nx ny nz, MGF
    /// n); (0, 0, 0) at vertices without one. Empty if no vertex has one. The sign is arbitrary: both sides of a face
    /// share vertices. Rays meet the flat patches; normals decide where shading is smooth and how it varies within a
    /// patch that bends with its neighbours. Plane faces ignore them (docs/method/method.md, Curved surfaces).
    std::vector<V3f> normals;
    PerPatch<Patch> patches;
    std::vector<Contact> contacts;  ///< Shading is discontinuous along these; see cut_at_contacts().
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Luminaire> luminaires;     ///< Light sources other than emitting patches.
    std::vector<LightGroup> light_groups;  ///< Groups whose light is kept separate (source_groups()).
    std::vector<std::string> objects;      ///< Names of the file's objects, such as "room.desk.leg"; [0] is "".
    std::vector<View> views;
    std::vector<std::string> files;  ///< Every file that was read, the scene file first.
    /// CRC-32 of each of `files` when read by load_scene(); empty if unknown.
    std::vector<std::uint32_t> file_checksums;
    Warnings warnings;
};

/// Violations of the invariants above (index out of range, non-finite number, reflectance outside [0, 1), negative
/// exitance, textured patch without coordinates, degenerate patch, invalid view) and of limits. At most 20; empty for a
/// valid scene.
std::vector<Fault> scene_faults(const Scene& scene);

/// @param purpose  Start of the message: "cannot solve".
/// @throws InputError that lists the faults, if any: "cannot solve 'room.mgf':" and one line per fault.
void require_no_faults(const std::vector<Fault>& faults, const std::string& purpose, const Scene& scene);

/// Largest coordinate of faces and views, in the world and from the scene's origin [m]; a double resolves 1/8 m there.
inline constexpr double farthest_coordinate = 1e15;

/// Returns whether no coordinate of a point exceeds farthest_coordinate or is NaN.
bool is_within_reach(const Imath::V3d& point);

/// Returns the area of a patch [m^2].
float patch_area(const Scene& scene, const Patch& patch);

/// Returns the unit normal of a patch, towards its lit side. For a warped quadrilateral it is the mean over its area.
V3f patch_normal(const Scene& scene, const Patch& patch);

/// Returns whether a patch or a luminaire emits light.
bool emits_light(const Scene& scene);

/// Returns the view of that name. @throws InputError that lists the views.
const View& find_view(const Scene& scene, const std::string& name);

/// Returns a view from inside an upper corner of the scene's bounding box to its middle, which may lie in a wall. The
/// overload in prepare.h avoids walls and darkness.
View overview(const Scene& scene);

/// Returns an orthographic view of the scene beyond a plane, with a margin; z up, or y in views along z.
/// @param point      Point on the plane, in world coordinates [m].
/// @param direction  Normal to the plane; not 0.
/// @param aspect     Width over height of the picture.
View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect);

/// @throws InputError for a view that defines no picture of this size: without a direction, with pixels finer than
///         the rounding of coordinates or ray directions, or with too many pixels.
/// @param origin  Scene::origin.
void require_picture(const View& view, int width, int height, const Imath::V3d& origin);

}  // namespace interflect
