#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads an IES LM-63 file (1986 to 2019) of photometric type A, B or C, with any symmetry, line breaks and separators.
/// Intensities include the multiplier, the ballast factor and, up to 1995, the ballast-lamp factor. The TILT factor is
/// that of the measurement position.
///
/// Warnings by kind: "ies-version", unknown first line; "ies-tilt", TILT factors other than 1; "ies-lumens", lumens
/// neither positive nor -1; "ies-angles", angles end early; "ies-negative", negative intensity, read as 0;
/// "ies-opening", unknown opening, read as a box; "ies-reserved", factor reserved by LM-63-2002; "ies-trailing", words
/// after the last intensity.
/// @throws InputError  with file and line for other invalid input and beyond the limits of `options`.
///
/// A TILT file must be in the file's folder or below unless `outside_files` is set. Messages do not quote it.
PhotometricWeb read_ies(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// Reads from memory. @param path  Name for messages; TILT files are relative to its folder.
PhotometricWeb read_ies_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

/// Reads a file embedded in or referenced by another. @param name  For messages.
/// @param folder  Folder of the TILT file.
PhotometricWeb read_enclosed_ies(std::string_view text, const std::filesystem::path& name,
                                 const std::filesystem::path& folder, const ReadOptions& options, Warnings& warnings);

}  // namespace interflect::detail
