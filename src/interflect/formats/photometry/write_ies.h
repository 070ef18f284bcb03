#pragma once

#include <filesystem>
#include <iosfwd>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Writes IES LM-63-2002: type B for its pole, type A for an incomplete azimuth, else type C. read_ies() restores
/// intensities but for rounding at azimuth 0. @throws std::runtime_error
void write_ies(const PhotometricWeb& web, std::ostream& out);
void write_ies(const PhotometricWeb& web, const std::filesystem::path& path);

}  // namespace interflect::detail
