#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "interflect/luminaire.h"
#include "interflect/texture.h"

namespace interflect::inline detail {

/// Reads a texture: .png or .jpg (sRGB), .exr or .hdr (linear).
/// @param most  Maximum number of texels.
/// @throws InputError  with path and reason, as read_image(), and for an invalid texture.
Texture read_texture(const std::filesystem::path& path, std::uint64_t most = most_texels);

/// Reads an environment map of radiances: .exr or .hdr.
/// @throws InputError  with path and reason, also for other formats.
std::shared_ptr<const Texture> read_environment(const std::filesystem::path& path);

/// Returns the extension of a lossless format: ".png" if all texels are 8-bit sRGB values, else ".exr".
std::string texture_extension(const Texture& texture);

/// Writes a texture in the format of the extension.
/// @throws InputError, std::runtime_error  as write_image().
void write_texture(const std::filesystem::path& path, const Texture& texture);

}  // namespace interflect::inline detail
