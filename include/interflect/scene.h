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

/// Index that points nowhere.
inline constexpr std::uint32_t none = 0xffffffffu;

/// What a surface does with light; the same on both sides of a two-sided face.
struct Material {
    std::string name;
    Rgb reflectance{0, 0, 0};  ///< Diffuse reflectance rho, each channel in [0, 1).
    Rgb exitance{0, 0, 0};     ///< Self-emitted exitance M [lm/m^2 or W/m^2], >= 0.
    /// Indices into Scene::textures, or none: what the reflectance and the exitance are multiplied by. The products
    /// keep within the limits of this struct.
    std::uint32_t reflectance_texture = none, exitance_texture = none;
    /// The share of light that goes straight through: thin glass, and with a texture the holes of a leaf or a fence.
    /// With the other reflectances at most 1 in sum.
    Rgb transmittance{0, 0, 0};
    std::uint32_t transmittance_texture = none;  ///< What the transmittance is multiplied by.
    /// Share of light that is mirrored: seen from the camera in gathered and path-traced pictures, lost to the solver.
    Rgb specular_reflectance{0, 0, 0};

    bool is_textured() const {
        return reflectance_texture != none || exitance_texture != none || transmittance_texture != none;
    }
};

/// One side of an input polygon: a triangle or a convex quadrilateral, planar within 2e-6 of its largest coordinate.
/// A more strongly warped quadrilateral has a larger ray offset, which prevents leaks but reduces accuracy near its
/// edges. Two triangles are exact.
struct Patch {
    /// Counter-clockwise seen from the lit side; [3] == none for a triangle.
    std::array<std::uint32_t, 4> vertices{none, none, none, none};
    std::uint32_t material = 0;
    std::uint32_t other_side = none;  ///< The patch on the back of the same face; none for a one-sided face.
    std::uint32_t object = 0;         ///< Index into Scene::objects.
    std::uint32_t surface = none;     ///< Equal in a flat surface of which a face was cut; none: edges tell.

    bool is_triangle() const { return vertices[3] == none; }
    int vertex_count() const { return is_triangle() ? 3 : 4; }
};

/// A segment along which a face was cut because another face meets it there: light differs on its two sides.
struct Contact {
    V3f a, b;  ///< Ends [m]; on edges of the pieces.
};

/// A pinhole camera, in world coordinates whatever the scene's origin: Camera makes it relative.
struct View {
    std::string name;
    Imath::V3d eye{0, 0, 0};      ///< [m]
    Imath::V3d look_at{0, 1, 0};  ///< [m]
    V3f up{0, 0, 1};              ///< Need be neither normalised nor perpendicular to the direction of view.
    float fov = 45;               ///< Vertical, full [degrees], in (0, 180).
    /// Above 0: orthographic, and the picture shows this much from top to bottom [m], whatever `fov` is. Its rays start
    /// on the plane through the eye, so that nothing behind it is seen: plans and sections. Solve without such a view.
    float extent = 0;
};

/// Everything that was read, in metres and linear Rec. 709; immutable once loaded. Patches of a two-sided face are
/// neighbours: the side as written first, its other_side right after it.
struct Scene {
    std::string name;  ///< The file it came from.
    /// World coordinates of the vertices' origin [m]: a vertex v lies at origin + v. A reader chooses it (origin_for in
    /// core.h), so that a scene keeps its precision wherever in the world it lies.
    Imath::V3d origin{0, 0, 0};
    std::vector<V3f> vertices;  ///< Relative to `origin` [m]. Those that no patch uses count for nothing.
    /// (u, v) of every vertex, or empty where no patch is textured.
    std::vector<V2f> texture_coordinates;
    /// (u, v) in [0, 1] of every vertex in its object's own lightmap, where the file has laid one out (TEXCOORD_1 of
    /// glTF); (0, 0) is the lower left corner. Empty where no patch has any. All corners of a patch have some, or none
    /// has: then they are NaN.
    std::vector<V2f> lightmap_coordinates;
    /// Unit normal of the smooth surface at every vertex, as the file has it (glTF NORMAL, OBJ vn, PLY nx ny nz, MGF
    /// n); (0, 0, 0) at vertices without one. Empty if no vertex has one. The sign is arbitrary: both sides of a face
    /// share vertices. Rays meet the flat patches; normals decide where shading is smooth and how it varies within a
    /// patch.
    std::vector<V3f> normals;
    std::vector<Patch> patches;
    std::vector<Contact> contacts;  ///< Shading is discontinuous there; see cut_at_contacts().
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Luminaire> luminaires;     ///< Sources of light beside the patches that emit.
    std::vector<LightGroup> light_groups;  ///< Whose light is kept apart; see source_groups().
    std::vector<std::string> objects;      ///< Names of the file's objects, such as "room.desk.leg"; [0] is "".
    std::vector<View> views;
    std::vector<std::string> files;  ///< Every file that was read, the scene's own first.
    /// CRC-32 of each of `files`, as load_scene() found them; empty where they are not known.
    std::vector<std::uint32_t> file_checksums;
    Warnings warnings;
};

/// Every fault of `scene` that would break an invariant above (index out of range, non-finite number, reflectance
/// outside [0, 1), negative exitance, textured patch without coordinates, degenerate patch, a view that shows nothing)
/// or is beyond what can be computed (limits.h), a sentence each; empty for a valid scene. Lists at most 20.
std::vector<std::string> scene_faults(const Scene& scene);

/// @param purpose  What the scene cannot be used for then: "cannot solve".
/// @throws InputError that lists the faults, if there are any: "cannot solve 'room.mgf':" and a line each.
void require_no_faults(const std::vector<std::string>& faults, const std::string& purpose, const Scene& scene);

}  // namespace interflect
