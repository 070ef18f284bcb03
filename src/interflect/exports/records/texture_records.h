#pragma once

#include <vector>

#include "interflect/exports/hdf5/hdf5_arrays.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/scene.h"

namespace interflect::detail {

// Solution files store the metadata of textures as JSON, and texels and coordinates as arrays.

Json json_of(const Texture& texture);
Json json_of(const std::vector<Texture>& textures);
/// Returns textures without texels. @throws Json::exception
std::vector<Texture> textures_of(const Json& json);

/// Adds the indices of a material's textures to its JSON.
void add_textures(const Material& material, Json& json);
/// Reads the indices of a material's textures. @throws Json::exception
void read_textures(const Json& json, Material& material);

/// Writes texels and coordinates. @return  Positions of the arrays in the file.
std::vector<FileRange> write_textures(Hdf5Writer& file, const Scene& scene);
/// Reads texels and coordinates into the scene. @throws std::runtime_error
void read_textures(const Hdf5Reader& file, Scene& scene);

}  // namespace interflect::detail
