#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads IES LM-63 (1986 to 2019), types A, B and C (docs/light/luminaires.md). `outside_files` applies to the TILT
/// file.
/// @throws InputError
PhotometricWeb read_ies(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

PhotometricWeb read_ies_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

/// @param folder  Folder of the TILT file.
PhotometricWeb read_enclosed_ies(std::string_view text, const std::filesystem::path& name,
                                 const std::filesystem::path& folder, const ReadOptions& options, Warnings& warnings);

}  // namespace interflect::detail
