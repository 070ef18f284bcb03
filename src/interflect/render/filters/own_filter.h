#pragma once

#include "interflect/image.h"
#include "interflect/render.h"

namespace interflect::detail {

/// Filters noise by exchanges between pairs of pixels: Denoiser::own.
/// @return  The picture, in its own unit.
Image own_filter(const PictureLayers& layers);

}  // namespace interflect::detail
