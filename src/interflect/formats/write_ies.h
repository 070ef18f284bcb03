#pragma once

#include <filesystem>
#include <iosfwd>

#include "interflect/photometric_web.h"

namespace interflect::inline detail {

/// Writes measured light after IES LM-63-2002, as type C, or types A and B where it does not go all around or has the
/// pole of type B. read_ies() gives back the same intensities, at an azimuth of 0 to a float's rounding.
/// @throws std::runtime_error where the file cannot be written.
void write_ies(const PhotometricWeb& web, std::ostream& out);
void write_ies(const PhotometricWeb& web, const std::filesystem::path& path);

}  // namespace interflect::inline detail
