#pragma once

#include <vector>

#include "interflect/exports/hdf5_arrays.h"
#include "interflect/exports/json_text.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

// Textures in a solution file: indices, names and sizes in its description, texels and coordinates as arrays.

/// Name and size of a texture, and of each.
Json json_of(const Texture& texture);
Json json_of(const std::vector<Texture>& textures);
/// The same textures, without their texels. @throws Json::exception where they are none.
std::vector<Texture> textures_of(const Json& json);

/// Adds the indices of a material's textures, where it has some, to its object in the description.
void add_textures(const Material& material, Json& json);
/// The inverse. @throws Json::exception
void read_textures(const Json& json, Material& material);

/// Writes the texels of a scene's textures and environment maps, and its texture and lightmap coordinates, where there
/// are some. @return Where they are.
std::vector<FileRange> write_textures(Hdf5Writer& file, const Scene& scene);
/// The inverse. @param scene  Has its textures and environment maps without their texels. @throws std::runtime_error
void read_textures(const Hdf5Reader& file, Scene& scene);

}  // namespace interflect::inline detail
