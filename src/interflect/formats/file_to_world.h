#pragma once

#include <ImathMatrix.h>

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// Returns the matrix from file coordinates to world coordinates: scales to metres and rotates options.up_axis to z.
/// For row vectors, p * M.
Imath::M44d file_to_world(const ReadOptions& options);

}  // namespace interflect::inline detail
