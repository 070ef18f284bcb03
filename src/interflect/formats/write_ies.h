#pragma once

#include <filesystem>
#include <iosfwd>

#include "interflect/photometric_web.h"

namespace interflect::inline detail {

/// Writes a photometric web in IES LM-63-2002 as type C; as type A if it does not go all around, and as type B if it
/// has the pole of type B. read_ies() restores the intensities exactly, except at azimuth 0 (float rounding).
/// @throws std::runtime_error  if writing fails.
void write_ies(const PhotometricWeb& web, std::ostream& out);
void write_ies(const PhotometricWeb& web, const std::filesystem::path& path);

}  // namespace interflect::inline detail
