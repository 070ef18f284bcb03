#pragma once

#include "interflect/image.h"

namespace interflect::detail {

/// Like read_image(), but also reads JPEG: textures may have lost detail, measurements may not.
Image read_photograph(const std::filesystem::path& path, std::int64_t most_pixels);

}  // namespace interflect::detail
