#pragma once

#include "interflect/image.h"

namespace interflect::detail {

/// As read_image(), and JPEG, too lossy for measurements.
Image read_photograph(const std::filesystem::path& path, std::int64_t max_pixels);

}  // namespace interflect::detail
