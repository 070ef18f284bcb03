#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/export.h"
#include "interflect/export_scene.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// What the backs of a mesh's faces do.
enum class Backs {
    pass,     ///< Let light through: one-sided faces.
    reflect,  ///< Reflect as the fronts do, but emit nothing.
    emit,     ///< As the fronts.
};

/// The faces of one material whose backs are alike.
struct ForeignMesh {
    std::string name;
    std::uint32_t material = 0;
    Backs backs = Backs::pass;
    std::vector<V3f> positions;                       ///< Relative to Scene::origin [m].
    std::vector<V2f> texture_coordinates;             ///< One for each position, or empty.
    std::vector<std::array<std::uint32_t, 4>> faces;  ///< The fourth of a triangle is none.

    /// With faces cut into triangles.
    std::vector<std::array<std::uint32_t, 3>> triangles() const;
};

/// A scene as other renderers take it, and the files that a description of it refers to.
struct ForeignScene {
    const Scene& scene;
    std::filesystem::path path;  ///< Of the description.
    SceneExportOptions options;
    std::string (*escape)(std::string_view file_name);  ///< For the text of the description.
    std::vector<std::string> materials;                 ///< Their names, all different.
    std::vector<std::string> luminaires;
    std::vector<ForeignMesh> meshes;
    std::vector<View> views;  ///< At least one; `eye` and `look_at` relative to Scene::origin.
    std::vector<ExportedFile> files;
    Warnings warnings;

    ForeignScene(const Scene& exported, const std::filesystem::path& description, const SceneExportOptions& chosen,
                 std::string (*file_name_escape)(std::string_view));

    /// Adds a file "STEM-name" beside the description. @return  Its name, escaped for the description.
    std::string add_file(const std::string& name, std::string bytes);
    /// The images of a material, in linear values: reflectance, radiance M / pi, and transmittance. @return  Its name.
    std::string add_reflectance_image(std::uint32_t material);
    std::string add_radiance_image(std::uint32_t material);
    std::string add_transmittance_image(std::uint32_t material);
    /// The same as opacity, and the reflectance of what is opaque (opacity.h).
    std::string add_opacity_image(std::uint32_t material);
    std::string add_opaque_reflectance_image(std::uint32_t material);
    /// All skies as one image of radiance; no name where there are none.
    /// @param direction  Of a point of the image, x from the left and y from the top, in [0, 1].
    std::string add_sky_image(int width, int height, const std::function<V3f(float x, float y)>& direction);

    const Material& material(const ForeignMesh& mesh) const { return scene.materials[mesh.material]; }
    bool emits(const ForeignMesh& mesh) const { return material(mesh).exitance != Rgb(0); }
    /// M / pi, where it is uniform.
    Rgb radiance(const ForeignMesh& mesh) const;
    /// Counts a warning: "left out: ".
    void leave_out(const std::string& what) { warnings.add("left-out", "left out: " + what); }

    /// Warns of all that no renderer but `has_glass` ones are told.
    /// @param has_holes  Whether it is told of textures of transmittance.
    void warn_of_materials(bool has_glass, bool has_holes);
};

/// The mean of an image.
Rgb mean_texel(const Texture& texture);

/// Binary PLY with triangles, for renderers; (u, v) as "u" and "v".
std::string ply_of(const ForeignMesh& mesh);

/// "0.5 0.25 1", with anything between.
std::string triple(const V3f& v, const char* between = " ");

// Each returns the description, and adds the files that it refers to.
std::string radiance_description(ForeignScene& scene);
std::string mitsuba_description(ForeignScene& scene);
std::string pbrt_description(ForeignScene& scene);
std::string blender_description(ForeignScene& scene);

}  // namespace interflect::inline detail
