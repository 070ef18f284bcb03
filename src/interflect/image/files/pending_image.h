#pragma once

#include "interflect/base/files/pending_file.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Writes the image and commits the file. Errors name its final path.
void write_image(PendingFile& file, const Image& image, const ImageMetadata& metadata = ImageMetadata(),
                 std::span<const ImageLayer> layers = {});

}  // namespace interflect::detail
