#pragma once

#include "interflect/image_files.h"

namespace interflect::inline detail {

/// As read_image(), and of JPEG files too: what surfaces show may have lost detail, what is measured may not.
Image read_photograph(const std::filesystem::path& path, std::int64_t most_pixels);

}  // namespace interflect::inline detail
