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

/// Turns what an MGF file says, already in world coordinates, into a Scene relative to an origin: welds vertices,
/// converts materials when a face first uses them, names objects, and counts what diffuse light transport leaves out.
/// Functions throw std::invalid_argument, with a sentence, where the file asks for what cannot be.
class MgfSceneBuilder {
  public:
    MgfSceneBuilder(const std::filesystem::path& file, const ReadOptions& options, const Imath::V3d& origin);

    void warn(const std::string& kind, const std::string& message, const Location& where);
    void add_file(const std::filesystem::path& file) { scene_.files.push_back(file.string()); }

    std::uint64_t patch_count() const { return scene_.patches.size(); }
    /// @throws std::invalid_argument  where `patches` more would pass the limit, to which faces left out count as well.
    void require_room(double patches) const { faces_.require_room(patches); }

    /// A place in the world [m], relative to the scene's origin.
    V3f position(const Imath::V3d& world) const { return faces_.position(world); }
    /// Index of the vertex at `world` [m] with these texture coordinates, if it has some.
    /// @param normal  In the world, of any length; zero for none.
    std::uint32_t vertex(const Imath::V3d& world, const std::optional<V2f>& texture_coordinate,
                         const Imath::V3d& normal = Imath::V3d(0)) {
        return weld_.vertex(position(world),
                            {.texture = texture_coordinate, .lightmap = {}, .normal = welded_normal(normal)});
    }
    /// What is emitted in a colour, in the unit of `luminance`.
    Rgb emitted(const MgfColour& colour, double luminance, const Location& where);
    /// Index of the material; remembers it in `material`.
    std::uint32_t material(MgfMaterial& material, std::string_view name);
    /// Index of the object with this dotted name.
    std::uint32_t object(const std::string& name);
    /// Adds a luminaire and names it "spot-3" after this and its place among all. @throws std::invalid_argument
    void add_light(Luminaire luminaire, const std::string& name);
    Warnings& warnings() { return scene_.warnings; }
    /// Tells where the outline of the face that is added next lies in the world, before rounding.
    void place_face(std::span<const Imath::V3d> outline) { faces_.place(outline); }
    /// Adds a face; one without area is left out.
    void add_face(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
                  bool two_sided, const Location& where) {
        faces_.add(loops, material, object, two_sided, where);
    }
    /// Counts a face that is left out. @param message  Says what kind of face.
    void leave_out(const std::string& message, const Location& where) { faces_.leave_out(message, where); }

    /// The origin that suits the faces added so far: where it is not the present one, the file should be read again.
    Imath::V3d suitable_origin() const { return faces_.suitable_origin(); }

    /// Adds the warnings that need the whole, and hands over the scene. @throws InputError where it has no patch, or
    /// lost a face that is as large as others to rounding, since it is too far from them.
    Scene finish();

  private:
    /// @param largest  Bound of every channel: largest_reflectance, or the largest float for an exitance.
    Rgb converted(const MgfColour& colour, double luminance, double largest, const Location& where);
    /// Index of the image, which is read where it is new; none where there is none.
    std::uint32_t texture(const MgfTexture& texture);
    /// That a material's reflectance and exitance keep within the limits where they are multiplied by its textures.
    void require_products(const Material& result, const MgfMaterial& material) const;
    void warn_of_lost(const std::string& kind, const std::string& what, double MgfMaterial::*share);

    Scene scene_;
    SceneFaces faces_;
    VertexWeld weld_;
    std::unordered_map<std::string, std::uint32_t> material_index_, object_index_, texture_index_;
    std::vector<Rgb> largest_texels_;          // of each of scene_.textures
    std::uint64_t texels_ = 0;                 // of all of them
    std::vector<MgfMaterial> used_materials_;  // one for each of scene_.materials
};

}  // namespace interflect::inline detail
