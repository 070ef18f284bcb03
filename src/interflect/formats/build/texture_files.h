#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "interflect/light_sources.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads .png or .jpg (sRGB), .exr or .hdr (linear). @param most  Maximum number of texels. @throws InputError
Texture read_texture(const std::filesystem::path& path, std::uint64_t most = max_texels);

/// Reads radiances from .exr or .hdr. @throws InputError
std::shared_ptr<const Texture> read_environment(const std::filesystem::path& path);

/// Returns the extension of a lossless format: ".png" for 8-bit sRGB values, else ".exr".
std::string texture_extension(const Texture& texture);

/// @throws InputError and std::runtime_error, as write_image() does.
void write_texture(const std::filesystem::path& path, const Texture& texture);

}  // namespace interflect::detail
