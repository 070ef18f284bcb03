#pragma once

#include "interflect/image_files.h"

namespace interflect::inline detail {

/// Reads an image like read_image(), but also from JPEG: lost detail is acceptable in textures, but not in
/// measurements.
Image read_photograph(const std::filesystem::path& path, std::int64_t most_pixels);

}  // namespace interflect::inline detail
