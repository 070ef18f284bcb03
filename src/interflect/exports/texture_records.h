#pragma once

#include <vector>

#include "interflect/exports/hdf5_arrays.h"
#include "interflect/exports/json_text.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

// Textures in a solution file: indices, names and sizes in its description, texels and coordinates as arrays.

/// Return the name and size of each texture.
Json json_of(const Texture& texture);
Json json_of(const std::vector<Texture>& textures);
/// Parses textures without their texels. @throws Json::exception for invalid records.
std::vector<Texture> textures_of(const Json& json);

/// Adds the indices of a material's textures to its object in the description.
void add_textures(const Material& material, Json& json);
/// Reads the indices back. @throws Json::exception
void read_textures(const Json& json, Material& material);

/// Writes the texels of textures and environment maps, and any texture and lightmap coordinates.
/// @return  Their positions in the file.
std::vector<FileRange> write_textures(Hdf5Writer& file, const Scene& scene);
/// Reads them back. @param scene  Has textures and environment maps without texels. @throws std::runtime_error
void read_textures(const Hdf5Reader& file, Scene& scene);

}  // namespace interflect::inline detail
