#pragma once

#include "interflect/base/files/pending_file.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Errors name the final file.
void write_image(PendingFile& file, const Image& image, const ImageMetadata& metadata = ImageMetadata(),
                 std::span<const ImageLayer> layers = {});

}  // namespace interflect::detail
