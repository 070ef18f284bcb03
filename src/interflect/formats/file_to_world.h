#pragma once

#include <ImathMatrix.h>

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// Scales to metres and rotates options.up_axis to z. For row vectors, p * M.
Imath::M44d file_to_world(const ReadOptions& options);

}  // namespace interflect::inline detail
