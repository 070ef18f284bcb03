#pragma once

#include <ImathMatrix.h>

#include "interflect/load.h"

namespace interflect::detail {

/// Returns the matrix that scales to metres and rotates options.up_axis to z.
Imath::M44d file_to_world(const ReadOptions& options);

}  // namespace interflect::detail
