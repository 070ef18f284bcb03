#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads an EULUMDAT file (Stockmar 1990). Intensities (per 1000 lm) are multiplied by the conversion factor and the
/// flux of the first lamp set. The opening is as high as its highest side. Warnings are of kind "ldt-*".
/// @throws InputError for invalid input and limits of `options`.
PhotometricWeb read_ldt(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// @param path  Name for messages.
PhotometricWeb read_ldt_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

}  // namespace interflect::detail
