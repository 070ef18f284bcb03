#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Writes a scene for read_mgf(), which restores the order of patches, names of materials and objects, exact world
/// positions, and textures. Colours are exact to 1e-6 of the largest channel; reflectances are limited to 0.99.
///
/// Not restored: unused vertices and materials; lightmap coordinates; names of textures; distinct vertices at one
/// position; different materials on backs; degenerate patches; views (see write_view_list()). White space, control
/// characters, '\', the leading '-' of a material and empty parts of an object's name become '_'.
///
/// @param scene  Without scene_faults(). Time is linear in patches, memory in vertices.
/// @param textures  texture_files(), relative to the scene's folder.
/// @param webs  web_files(), for photometric_webs().
/// @param maps  map_files(), for environment_maps().
/// @throws std::runtime_error if writing fails, or for a wrong number of files.
void write_mgf(const Scene& scene, std::ostream& out, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});
void write_mgf(const Scene& scene, const std::filesystem::path& path, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});

/// Returns "room.texture-0.png" (or .exr) for "room.mgf". Use write_texture().
std::vector<std::string> texture_files(const Scene& scene, const std::filesystem::path& path);

/// Returns each web once, in the order of the luminaires.
std::vector<std::shared_ptr<const PhotometricWeb>> photometric_webs(const Scene& scene);

/// Returns "room.web-0.ies" for "room.mgf". Use write_ies().
std::vector<std::string> web_files(const Scene& scene, const std::filesystem::path& path);

/// Returns "room.map-0.exr" for "room.mgf". Use write_texture().
std::vector<std::string> map_files(const Scene& scene, const std::filesystem::path& path);

}  // namespace interflect::detail
