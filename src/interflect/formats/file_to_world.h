#pragma once

#include <ImathMatrix.h>

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// From a file's coordinates to the world: metres, turned as options.up_axis has it. Of row vectors, p * M.
Imath::M44d file_to_world(const ReadOptions& options);

}  // namespace interflect::inline detail
