#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "interflect/luminaire.h"
#include "interflect/texture.h"

namespace interflect::inline detail {

/// Reads an image as a texture: .png or .jpg (sRGB), .exr or .hdr (linear).
/// @param most  Texels that it may have.
/// @throws InputError with the path and the reason, as read_image() does, and for a texture with a fault.
Texture read_texture(const std::filesystem::path& path, std::uint64_t most = most_texels);

/// Reads the image of an environment map, which has radiances: .exr or .hdr.
/// @throws InputError with the path and the reason, for other formats too.
std::shared_ptr<const Texture> read_environment(const std::filesystem::path& path);

/// The extension of the file that keeps every texel as it is: ".png" where all are what 8 bit sRGB has, else ".exr".
std::string texture_extension(const Texture& texture);

/// Writes a texture in the format of the path's extension.
/// @throws InputError, std::runtime_error as write_image() does.
void write_texture(const std::filesystem::path& path, const Texture& texture);

}  // namespace interflect::inline detail
