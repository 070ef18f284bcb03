#pragma once

#include <filesystem>
#include <iosfwd>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Writes IES LM-63-2002: type B for webs with the pole at C90, type A for an incomplete azimuth, otherwise type C.
/// read_ies() restores the intensities up to rounding at azimuth 0. @throws std::runtime_error
void write_ies(const PhotometricWeb& web, std::ostream& out);
void write_ies(const PhotometricWeb& web, const std::filesystem::path& path);

}  // namespace interflect::detail
