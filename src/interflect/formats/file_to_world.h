#pragma once

#include <ImathMatrix.h>

#include "interflect/load.h"

namespace interflect::detail {

/// Scales to metres and rotates options.up_axis to z; for row vectors.
Imath::M44d file_to_world(const ReadOptions& options);

}  // namespace interflect::detail
