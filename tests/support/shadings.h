#pragma once

#include "interflect/render.h"

namespace interflect::testing_support {

inline PictureOptions by(Shading shading, PictureOptions options = {}) {
    options.shading = shading;
    return options;
}

}  // namespace interflect::testing_support
