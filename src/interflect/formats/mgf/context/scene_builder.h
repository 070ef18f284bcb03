#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "interflect/formats/build/scene_faces.h"
#include "interflect/formats/mgf/context/contexts.h"
#include "interflect/geometry/search/vertex_weld.h"
#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Builds a scene from faces in world coordinates. Throws std::invalid_argument for invalid requests.
class MgfSceneBuilder {
  public:
    MgfSceneBuilder(const std::filesystem::path& file, const ReadOptions& options, const Imath::V3d& origin);

    void warn(const std::string& kind, const std::string& message, const Location& where);
    void warn_of_bright_reflectance(const Location& where);
    void add_file(const std::filesystem::path& file) { scene_.files.push_back(file.string()); }

    std::uint64_t patch_count() const { return scene_.patches.size(); }
    void require_room(double patches) const { faces_.require_room(patches); }

    V3f position(const Imath::V3d& world) const { return faces_.position(world); }
    /// @param world  Position [m]. @param normal  Normal of any length, or 0.
    std::uint32_t vertex(const Imath::V3d& world, const std::optional<V2f>& texture_coordinate,
                         const Imath::V3d& normal = Imath::V3d(0)) {
        return weld_.vertex(position(world),
                            {.texture = texture_coordinate, .lightmap = {}, .normal = welded_normal(normal)});
    }
    /// Returns linear Rec. 709 in the unit of `luminance`.
    Rgb emitted(const MgfColour& colour, double luminance, const Location& where);
    /// Adds the material to the scene, unless it has an index already, and stores the index in it.
    std::uint32_t material(MgfMaterial& material, std::string_view name);
    std::uint32_t object(const std::string& name);
    /// Appends a number to the name: "spot-3".
    void add_light(Luminaire luminaire, const std::string& name);
    Warnings& warnings() { return scene_.warnings; }
    void place_face(std::span<const Imath::V3d> outline) { faces_.place(outline); }
    void add_face(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
                  bool two_sided, const Location& where) {
        faces_.add(loops, material, object, two_sided, where);
    }
    void leave_out(const std::string& message, const Location& where) { faces_.leave_out(message, where); }

    /// Returns an origin for the scene. If it differs from Scene::origin, read the file again.
    Imath::V3d suitable_origin() const { return faces_.suitable_origin(); }

    /// @throws InputError as SceneFaces::require_usable().
    Scene finish();

  private:
    Rgb converted(const MgfColour& colour, double luminance, double largest, const Location& where);
    std::uint32_t texture(const MgfTexture& texture);
    /// Requires that factors times textures are in range.
    void require_products(const Material& result, const MgfMaterial& material) const;
    void warn_of_lost(const std::string& kind, const std::string& what, double MgfMaterial::*share);

    Scene scene_;
    SceneFaces faces_;
    VertexWeld weld_;
    std::unordered_map<std::string, std::uint32_t> material_index_, object_index_, texture_index_;
    std::vector<Rgb> largest_texels_;  // one per texture
    std::uint64_t texels_ = 0;
    std::vector<MgfMaterial> used_materials_;  // one per material of the scene
};

}  // namespace interflect::detail
