#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/photometric_web.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// Reads a photometric file in IES LM-63 format, versions 1986 to 2019. Supports types A, B and C, every symmetry, and
/// any line breaks and separators. Intensities are multiplied by the multiplier, the ballast factor and, up to 1995,
/// the ballast-lamp factor. The TILT factor is that of the measurement position.
///
/// Warnings, counted by kind: "ies-version", an unknown first line; "ies-tilt", TILT factors other than 1;
/// "ies-lumens", lamp lumens neither positive nor -1; "ies-angles", angles that end early; "ies-negative", a negative
/// intensity, read as 0; "ies-opening", an opening of unknown shape, read as a box; "ies-reserved", a factor that
/// LM-63-2002 reserves; "ies-trailing", words after the last intensity.
/// @throws InputError  with file and line for any other deviation from the format, and beyond the limits of `options`.
///
/// A TILT file must be in the folder of the file or below, unless `outside_files` is set. Messages do not quote it.
PhotometricWeb read_ies(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// Reads from memory. @param path  Name for messages; its folder contains the TILT files.
PhotometricWeb read_ies_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

/// Reads a file that is embedded in another file or referenced by it. @param name  For messages.
/// @param folder  Folder of the TILT file, which may be elsewhere if `outside_files` is set.
PhotometricWeb read_enclosed_ies(std::string_view text, const std::filesystem::path& name,
                                 const std::filesystem::path& folder, const ReadOptions& options, Warnings& warnings);

}  // namespace interflect::inline detail
