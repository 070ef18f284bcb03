#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"
#include "interflect/scene.h"

namespace interflect::detail {

enum class Backs {
    pass,  ///< Transmit light: one-sided faces.
    reflect,
    emit,  ///< Reflect and emit like the fronts.
};

struct ForeignMesh {
    std::string name;
    std::uint32_t material = 0;
    Backs backs = Backs::pass;
    std::vector<V3f> positions;                       ///< Relative to Scene::origin [m].
    std::vector<V2f> texture_coordinates;             ///< One per position, or empty.
    std::vector<std::array<std::uint32_t, 4>> faces;  ///< Vertex indices; triangles end with `none`.

    std::vector<std::array<std::uint32_t, 3>> triangles() const;
    /// Returns the reversed faces, each with its own vertices, shifted behind the fronts: emitters of other renderers
    /// shine on one side. @param distance  [m]
    ForeignMesh shifted_backs(float distance) const;
};

struct ForeignScene {
    const Scene& scene;
    std::filesystem::path path;
    SceneExportOptions options;
    std::string (*escape)(std::string_view file_name);
    std::vector<std::string> materials;
    std::vector<std::string> luminaires;
    std::vector<ForeignMesh> meshes;
    std::vector<View> views;  ///< At least one, relative to Scene::origin.
    V3f centre;               ///< Centre of the bounding box [m].
    float size = 0;           ///< Largest distance of a vertex from `centre` [m].
    std::vector<ExportedFile> files;
    Warnings warnings;

    ForeignScene(const Scene& exported, const std::filesystem::path& description, const SceneExportOptions& chosen,
                 std::string (*file_name_escape)(std::string_view));

    /// Adds a file of path_beside(); returns its escaped name.
    std::string add_file(const std::string& name, std::string bytes);
    /// Add a linear image; return its escaped name. Radiance is M / pi.
    std::string add_reflectance_image(std::uint32_t material);
    std::string add_radiance_image(std::uint32_t material);
    std::string add_transmittance_image(std::uint32_t material);
    /// See opacity.h.
    std::string add_opacity_image(std::uint32_t material);
    std::string add_opaque_reflectance_image(std::uint32_t material);
    bool has_sky() const;
    /// Returns the mean radiance of all skies in each texel. The width is `aspect` times the height.
    /// @param direction  Maps image coordinates in [0, 1], y downwards.
    Texture sky_image(int aspect, const std::function<V3f(float x, float y)>& direction) const;
    /// Adds it; returns "" without skies.
    std::string add_sky_image(int aspect, const std::function<V3f(float x, float y)>& direction);

    const Material& material(const ForeignMesh& mesh) const { return scene.materials[mesh.material]; }
    bool is_cut_out(const ForeignMesh& mesh) const { return material(mesh).transmittance_texture != none; }
    bool emits(const ForeignMesh& mesh) const { return material(mesh).exitance != Rgb(0); }
    Rgb radiance(const ForeignMesh& mesh) const;
    void leave_out(const std::string& what) { warnings.add("left-out", "left out: " + what); }

    /// Distance between the two sides of an emitting face [m].
    float distance_of_backs() const;

    enum class Support { all, without_glass, without_glass_and_backs };
    /// Warns about panes of glass, and one-sided faces, that the renderer makes opaque; and about mirrors.
    void warn_of_materials(Support support);
};

Rgb mean_texel(const Texture& texture);

/// Encodes binary PLY with texture coordinates "u" and "v".
std::string ply_of(const ForeignMesh& mesh);

/// Formats "0.5 0.25 1".
std::string triple(const V3f& v, const char* between = " ");

// Return the description and add its files.
std::string radiance_description(ForeignScene& scene);
std::string mitsuba_description(ForeignScene& scene);
std::string pbrt_description(ForeignScene& scene);
std::string blender_description(ForeignScene& scene);

}  // namespace interflect::detail
