#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interflect/colour.h"
#include "interflect/light_groups.h"
#include "interflect/luminaire.h"
#include "interflect/texture.h"
#include "interflect/warnings.h"

namespace interflect {

/// Invalid index.
inline constexpr std::uint32_t none = 0xffffffffu;

/// Material of a surface; the same on both sides of a two-sided face.
struct Material {
    std::string name;
    Rgb reflectance{0, 0, 0};  ///< Diffuse reflectance rho, each channel in [0, 1).
    Rgb exitance{0, 0, 0};     ///< Self-emitted exitance M [lm/m^2 or W/m^2], >= 0.
    /// Textures that multiply the reflectance and the exitance (indices into Scene::textures, or none). The products
    /// obey the limits above.
    std::uint32_t reflectance_texture = none, exitance_texture = none;
    /// Fraction of light that passes straight through: thin glass, or with a texture the holes of a leaf or a fence. At
    /// most 1 in sum with both reflectances.
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
    std::uint32_t other_side = none;  ///< Patch on the back of the face; none if one-sided.
    std::uint32_t object = 0;         ///< Index into Scene::objects.
    std::uint32_t surface = none;     ///< Equal within a flat surface with cut faces; none: derived from edges.

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
    Imath::V3d eye{0, 0, 0};      ///< [m]
    Imath::V3d look_at{0, 1, 0};  ///< [m]
    V3f up{0, 0, 1};              ///< Need not be normalised or perpendicular to the view direction.
    float fov = 45;               ///< Vertical, full [degrees], in (0, 180).
    /// Above 0: orthographic, height of the picture [m]; `fov` is ignored. Rays start on the plane through the eye,
    /// which cuts the scene: plans and sections. Do not solve with such a view.
    float extent = 0;
};

/// Scene in metres and linear Rec. 709; immutable once loaded. The patches of a two-sided face are adjacent, the side
/// in the file first.
struct Scene {
    std::string name;  ///< Source file.
    /// World coordinates of the vertices' origin [m]. Chosen by readers (origin_for in core.h) to preserve precision.
    Imath::V3d origin{0, 0, 0};
    std::vector<V3f> vertices;  ///< Relative to `origin` [m]. Unused vertices are ignored.
    /// (u, v) of every vertex, or empty if no patch is textured.
    std::vector<V2f> texture_coordinates;
    /// (u, v) in [0, 1] of every vertex in its object's own lightmap, if the file provides one (TEXCOORD_1 of glTF);
    /// (0, 0) is the lower left corner. Empty without any. The corners of a patch either all have coordinates or are
    /// all NaN.
    std::vector<V2f> lightmap_coordinates;
    /// Unit normal of the smooth surface at every vertex, as the file has it (glTF NORMAL, OBJ vn, PLY nx ny nz, MGF
    /// n); (0, 0, 0) at vertices without one. Empty if no vertex has one. The sign is arbitrary: both sides of a face
    /// share vertices. Rays meet the flat patches; normals decide where shading is smooth and how it varies within a
    /// patch.
    std::vector<V3f> normals;
    std::vector<Patch> patches;
    std::vector<Contact> contacts;  ///< Shading is discontinuous along these; see cut_at_contacts().
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Luminaire> luminaires;     ///< Light sources other than emitting patches.
    std::vector<LightGroup> light_groups;  ///< Groups whose light is kept separate; see source_groups().
    std::vector<std::string> objects;      ///< Names of the file's objects, such as "room.desk.leg"; [0] is "".
    std::vector<View> views;
    std::vector<std::string> files;  ///< Every file that was read, the scene file first.
    /// CRC-32 of each of `files` when read by load_scene(); empty if unknown.
    std::vector<std::uint32_t> file_checksums;
    Warnings warnings;
};

/// Violations of the invariants above (index out of range, non-finite number, reflectance outside [0, 1), negative
/// exitance, textured patch without coordinates, degenerate patch, invalid view) and of limits.h, one sentence each. At
/// most 20; empty for a valid scene.
std::vector<std::string> scene_faults(const Scene& scene);

/// @param purpose  Start of the message: "cannot solve".
/// @throws InputError that lists the faults, if any: "cannot solve 'room.mgf':" and a line each.
void require_no_faults(const std::vector<std::string>& faults, const std::string& purpose, const Scene& scene);

}  // namespace interflect
