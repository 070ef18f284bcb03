#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "interflect/formats/mgf_contexts.h"
#include "interflect/formats/scene_faces.h"
#include "interflect/geometry/vertex_weld.h"
#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Builds a Scene from MGF data in world coordinates, relative to an origin. Welds vertices, converts materials on
/// first use by a face, names objects, and counts omitted light transport. Throws std::invalid_argument with a sentence
/// for impossible requests.
class MgfSceneBuilder {
  public:
    MgfSceneBuilder(const std::filesystem::path& file, const ReadOptions& options, const Imath::V3d& origin);

    void warn(const std::string& kind, const std::string& message, const Location& where);
    void add_file(const std::filesystem::path& file) { scene_.files.push_back(file.string()); }

    std::uint64_t patch_count() const { return scene_.patches.size(); }
    /// @throws std::invalid_argument  if `patches` more would exceed the limit. Omitted faces count as well.
    void require_room(double patches) const { faces_.require_room(patches); }

    /// Converts a world position [m] to one relative to the scene's origin.
    V3f position(const Imath::V3d& world) const { return faces_.position(world); }
    /// Returns the index of the vertex at `world` [m] with the given texture coordinates, if any.
    std::uint32_t vertex(const Imath::V3d& world, const std::optional<V2f>& texture_coordinate) {
        return weld_.vertex(position(world), {.texture = texture_coordinate, .lightmap = {}});
    }
    /// Returns the emission of a colour, in the unit of `luminance`.
    Rgb emitted(const MgfColour& colour, double luminance, const Location& where);
    /// Returns the index of the material and stores it in `material`.
    std::uint32_t material(MgfMaterial& material, std::string_view name);
    /// Returns the index of the object with this dotted name.
    std::uint32_t object(const std::string& name);
    /// Adds a luminaire named "spot-3": `name` and its number among all. @throws std::invalid_argument
    void add_light(Luminaire luminaire, const std::string& name);
    Warnings& warnings() { return scene_.warnings; }
    /// Sets the world position of the next face's outline, before rounding.
    void place_face(std::span<const Imath::V3d> outline) { faces_.place(outline); }
    /// Adds a face. Omits faces without area.
    void add_face(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
                  bool two_sided, const Location& where) {
        faces_.add(loops, material, object, two_sided, where);
    }
    /// Counts an omitted face. @param message  Describes the kind of face.
    void leave_out(const std::string& message, const Location& where) { faces_.leave_out(message, where); }

    /// Returns the best origin for the faces added so far. If it differs from the current one, read the file again.
    Imath::V3d suitable_origin() const { return faces_.suitable_origin(); }

    /// Adds the warnings about the whole scene and returns it. @throws InputError  if it has no patch, or if rounding
    /// removed a distant face as large as others.
    Scene finish();

  private:
    /// @param largest  Upper bound of every channel: largest_reflectance, or the largest float for an exitance.
    Rgb converted(const MgfColour& colour, double luminance, double largest, const Location& where);
    /// Returns the index of the image, reading it on first use; none for an empty path.
    std::uint32_t texture(const MgfTexture& texture);
    /// Requires reflectance and exitance times the textures to be within the limits.
    void require_products(const Material& result, const MgfMaterial& material) const;
    void warn_of_lost(const std::string& kind, const std::string& what, double MgfMaterial::*share);

    Scene scene_;
    SceneFaces faces_;
    VertexWeld weld_;
    std::unordered_map<std::string, std::uint32_t> material_index_, object_index_, texture_index_;
    std::vector<Rgb> largest_texels_;          // one per texture of the scene
    std::uint64_t texels_ = 0;                 // in all textures
    std::vector<MgfMaterial> used_materials_;  // one per material of the scene
};

}  // namespace interflect::inline detail
