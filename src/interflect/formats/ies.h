#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads an IES LM-63 file (1986 to 2019) of photometric type A, B or C. Intensities include the multiplier, the
/// ballast factor, the TILT factor at the measurement position and, until LM-63-1995, the ballast-lamp factor. Warnings
/// are of kind "ies-*".
///
/// The TILT file must be in the file's folder or below, unless `outside_files` is set. Messages do not quote it.
/// @throws InputError for invalid input and limits of `options`.
PhotometricWeb read_ies(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// @param path  Name for messages; its folder contains the TILT file.
PhotometricWeb read_ies_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

/// For a file embedded in or referenced by another.
/// @param name  For messages.
/// @param folder  Contains the TILT file.
PhotometricWeb read_enclosed_ies(std::string_view text, const std::filesystem::path& name,
                                 const std::filesystem::path& folder, const ReadOptions& options, Warnings& warnings);

}  // namespace interflect::detail
