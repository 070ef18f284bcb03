#pragma once

#include "interflect/base/pending_file.h"
#include "interflect/image_files.h"

namespace interflect::inline detail {

/// write_image() into a file that appears under its name once it is complete: commits it. Errors have its final name.
void write_image(PendingFile& file, const Image& image, const ImageMetadata& metadata = ImageMetadata(),
                 std::span<const ImageLayer> layers = {});

}  // namespace interflect::inline detail
