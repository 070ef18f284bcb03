#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Writes a scene in the Materials and Geometry Format. read_mgf() restores the same patches in the same order, the
/// names of materials and objects, and exact world positions (shortest decimals). Colours become a chromaticity (`cxy`)
/// and a luminous quantity (`rd`, `rs`, `ts`, `ed`). Their channels are restored to within 1e-6 of the largest;
/// reflectances are limited to 0.99. Texture coordinates and textures are restored exactly, except for the textures'
/// names.
///
/// Not restored: unused vertices and materials; lightmap coordinates; distinct vertices at one position; different
/// materials on the backs of faces; degenerate patches (add_polygon); views (see write_view_list()). In names, white
/// space, control characters and '\' become '_', as do a '-' at the start of a material's name and an empty part of an
/// object's name.
///
/// @param scene     Without scene_faults(). Time is linear in patches, memory in vertices (4 bytes each).
/// @param textures  File names of the textures, relative to the scene's folder: texture_files().
/// @param webs      File names of photometric_webs(): web_files().
/// @param maps      File names of environment_maps(): map_files().
/// @throws std::runtime_error  if writing fails.
void write_mgf(const Scene& scene, std::ostream& out, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});
void write_mgf(const Scene& scene, const std::filesystem::path& path, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});

/// Returns file names for the textures, for write_texture(): "room.texture-0.png" beside "room.mgf", or .exr
/// (texture_extension).
std::vector<std::string> texture_files(const Scene& scene, const std::filesystem::path& path);

/// Returns the distinct photometric webs of a scene, in the order of its luminaires.
std::vector<std::shared_ptr<const PhotometricWeb>> photometric_webs(const Scene& scene);

/// Returns file names for the webs, for write_ies(): "room.web-0.ies" beside "room.mgf".
std::vector<std::string> web_files(const Scene& scene, const std::filesystem::path& path);

/// Returns file names for the environment maps, for write_texture(): "room.map-0.exr" beside "room.mgf".
std::vector<std::string> map_files(const Scene& scene, const std::filesystem::path& path);

}  // namespace interflect::inline detail
