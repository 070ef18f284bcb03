#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/photometric_web.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// Reads a file of measured light after IES LM-63, of 1986 to 2019: photometry of types C, B and A with every symmetry,
/// line breaks and separators of any kind. Intensities are those of the file times its multiplier, its ballast factor
/// and, in files up to 1995, its ballast-lamp factor. TILT factors are those of the position of the measurement.
///
/// Tolerated with a warning, counted by kind: "ies-version", an unknown first line; "ies-tilt", TILT factors other than
/// 1; "ies-lumens", a flux of the lamps that is neither positive nor -1; "ies-angles", angles that end early;
/// "ies-negative", a negative intensity, read as 0; "ies-opening", an opening of unknown shape, read as a box;
/// "ies-reserved", a factor that LM-63-2002 does not use; "ies-trailing", words after the last intensity.
/// @throws InputError with file and line, for what is not as above, and beyond the limits of `options`.
///
/// A TILT file lies in the folder of the file or below, unless `outside_files` is set; no message quotes it.
PhotometricWeb read_ies(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// The same from memory. @param path  Name for messages; its folder is where TILT files are looked for.
PhotometricWeb read_ies_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

/// The same of a file within another or named by another. @param name    For messages.
/// @param folder  Folder of its TILT file; with `outside_files` that may lie elsewhere.
PhotometricWeb read_enclosed_ies(std::string_view text, const std::filesystem::path& name,
                                 const std::filesystem::path& folder, const ReadOptions& options, Warnings& warnings);

}  // namespace interflect::inline detail
