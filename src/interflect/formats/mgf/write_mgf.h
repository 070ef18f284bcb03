#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Writes a scene for read_mgf(), which restores patch order, names of materials and objects, exact world positions,
/// textures, and colours to 1e-6 of the largest channel. Reflectances are limited to 0.99.
///
/// Not restored: unused vertices and materials, lightmap coordinates, texture names, distinct vertices at one position,
/// different materials on backs, degenerate patches, and views. Invalid characters in names become '_'.
/// @param scene  A scene without scene_faults().
/// @param textures, webs, maps  texture_files(), web_files() and map_files().
/// @throws std::runtime_error, also for a wrong number of files.
void write_mgf(const Scene& scene, std::ostream& out, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});
void write_mgf(const Scene& scene, const std::filesystem::path& path, std::span<const std::string> textures = {},
               std::span<const std::string> webs = {}, std::span<const std::string> maps = {});

/// Returns names such as "room.texture-0.png", or .exr.
std::vector<std::string> texture_files(const Scene& scene, const std::filesystem::path& path);

/// Returns each web once, in luminaire order.
std::vector<std::shared_ptr<const PhotometricWeb>> photometric_webs(const Scene& scene);

/// Returns names such as "room.web-0.ies".
std::vector<std::string> web_files(const Scene& scene, const std::filesystem::path& path);

/// Returns names such as "room.map-0.exr".
std::vector<std::string> map_files(const Scene& scene, const std::filesystem::path& path);

}  // namespace interflect::detail
