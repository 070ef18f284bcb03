#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Writes a scene in the Materials and Geometry Format, so that read_mgf() gives it back: the same patches in the same
/// order, with materials and objects of the same names and vertices at exactly the same positions in the
/// world (the shortest decimals that round to them). Reflectance and exitance become a chromaticity (`cxy`) and a
/// luminous quantity (`rd`, `ed`); their channels come back to within 1e-6 of the largest, reflectances above 0.99 as
/// 0.99. Texture coordinates and textures come back exactly, but for the textures' names.
///
/// What does not come back: vertices and materials that no patch uses; lightmap coordinates, vertices that lie at
/// one position apart from each other; materials of their own on the backs of faces; patches that add_polygon() takes
/// for degenerate; views, for which there is write_view_list(); characters that the format has no room for: white
/// space, control characters and '\' in a name become '_', so do a
/// '-' at the start of a material's and an empty part of an object's.
///
/// @param scene     Without scene_faults(). Time is linear in the patches, memory in the vertices (4 bytes each).
/// @param textures  Names of the files of the scene's textures, relative to that of the scene: texture_files().
/// @param webs      Names of the files of photometric_webs(): web_files().
/// @param maps      Names of the files of environment_maps(): map_files().
/// @throws std::runtime_error where the stream fails, or the file cannot be written.
void write_mgf(const Scene& scene, std::ostream& out, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});
void write_mgf(const Scene& scene, const std::filesystem::path& path, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});

/// Names for the files of a scene's textures, beside that of the scene: "room.texture-0.png" beside "room.mgf", or .exr
/// (texture_extension). write_texture() writes them.
std::vector<std::string> texture_files(const Scene& scene, const std::filesystem::path& path);

/// The photometric webs of a scene's luminaires, each once, in the order of the luminaires.
std::vector<std::shared_ptr<const PhotometricWeb>> photometric_webs(const Scene& scene);

/// Names for their files beside that of the scene: "room.web-0.ies" beside "room.mgf". write_ies() writes them.
std::vector<std::string> web_files(const Scene& scene, const std::filesystem::path& path);

/// Names for the files of a scene's environment maps: "room.map-0.exr" beside "room.mgf". write_texture() writes them.
std::vector<std::string> map_files(const Scene& scene, const std::filesystem::path& path);

}  // namespace interflect::inline detail
