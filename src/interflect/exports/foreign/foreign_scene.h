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

/// Effect of the backs of faces on light.
enum class Backs {
    pass,     ///< Transmit it, as one-sided faces do.
    reflect,  ///< Reflect it.
    emit,     ///< Reflect and emit like the fronts.
};

/// Faces with the same material and backs.
struct ForeignMesh {
    std::string name;
    std::uint32_t material = 0;
    Backs backs = Backs::pass;
    std::vector<V3f> positions;                       ///< Relative to Scene::origin [m].
    std::vector<V2f> texture_coordinates;             ///< One per position, or empty.
    std::vector<std::array<std::uint32_t, 4>> faces;  ///< Vertex indices; triangles end with `none`.

    std::vector<std::array<std::uint32_t, 3>> triangles() const;
    /// Returns the reversed faces, shifted behind the fronts, each with its own vertices. They are needed because
    /// emitters of other renderers emit on one side only.
    /// @param distance  Distance of the shift [m].
    ForeignMesh shifted_backs(float distance) const;
};

/// A scene to be described for another renderer, with the files of the description.
struct ForeignScene {
    const Scene& scene;
    std::filesystem::path path;  ///< Path of the description.
    SceneExportOptions options;
    std::string (*escape)(std::string_view file_name);  ///< Escapes a file name for the description.
    std::vector<std::string> materials;                 ///< Unique names.
    std::vector<std::string> luminaires;                ///< Unique names.
    std::vector<ForeignMesh> meshes;
    std::vector<View> views;  ///< At least one, relative to Scene::origin.
    V3f centre;               ///< Centre of the bounding box [m].
    float size = 0;           ///< Largest distance of a vertex from `centre` [m].
    std::vector<ExportedFile> files;
    Warnings warnings;

    ForeignScene(const Scene& exported, const std::filesystem::path& description, const SceneExportOptions& chosen,
                 std::string (*file_name_escape)(std::string_view));

    /// Adds a file named by path_beside(). Returns its escaped name.
    std::string add_file(const std::string& name, std::string bytes);
    /// Add a linear image and return its escaped name. Radiance is exitance / pi.
    std::string add_reflectance_image(std::uint32_t material);
    std::string add_radiance_image(std::uint32_t material);
    std::string add_transmittance_image(std::uint32_t material);
    /// Add images of opacity and of the reflectance of opaque parts (see opacity.h), and return their escaped names.
    std::string add_opacity_image(std::uint32_t material);
    std::string add_opaque_reflectance_image(std::uint32_t material);
    bool has_sky() const;
    /// Returns the total radiance of the skies, averaged over each texel. The width is `aspect` times the height.
    /// @param direction  Maps image coordinates in [0, 1], with y downwards, to directions.
    Texture sky_image(int aspect, const std::function<V3f(float x, float y)>& direction) const;
    /// Adds the image of the skies. Returns its escaped name, or "" without skies.
    std::string add_sky_image(int aspect, const std::function<V3f(float x, float y)>& direction);

    const Material& material(const ForeignMesh& mesh) const { return scene.materials[mesh.material]; }
    bool is_cut_out(const ForeignMesh& mesh) const { return material(mesh).transmittance_texture != none; }
    bool emits(const ForeignMesh& mesh) const { return material(mesh).exitance != Rgb(0); }
    Rgb radiance(const ForeignMesh& mesh) const;
    void leave_out(const std::string& what) { warnings.add("left-out", "left out: " + what); }

    /// Returns the distance between the two sides of an emitting face [m].
    float distance_of_backs() const;

    /// Materials that the other renderer supports.
    enum class Support { all, without_glass, without_glass_and_backs };
    /// Warns about mirrors, and about panes and one-sided faces that are opaque in the other renderer.
    void warn_of_materials(Support support);
};

Rgb mean_texel(const Texture& texture);

/// Encodes binary PLY with texture coordinates "u" and "v".
std::string ply_of(const ForeignMesh& mesh);

/// Formats three numbers, such as "0.5 0.25 1".
std::string triple(const V3f& v, const char* between = " ");

// These functions return the description of the scene and add the files to which it refers.
std::string radiance_description(ForeignScene& scene);
std::string mitsuba_description(ForeignScene& scene);
std::string pbrt_description(ForeignScene& scene);
std::string blender_description(ForeignScene& scene);

/// Returns the direction of a point of an image of latitudes and longitudes, see ForeignScene::sky_image().
V3f latitude_longitude_direction(float x, float y);

}  // namespace interflect::detail
