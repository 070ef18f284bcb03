#pragma once

#include "interflect/image.h"

namespace interflect::detail {

/// Reads the formats of read_image(), and JPEG, which is too lossy for measurements.
Image read_photograph(const std::filesystem::path& path, std::int64_t max_pixels);

}  // namespace interflect::detail
