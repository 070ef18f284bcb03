#pragma once

#include "interflect/base/files/pending_file.h"
#include "interflect/view_factors.h"

namespace interflect::detail {

/// Writes the members of ViewFactors as arrays of an uncompressed .npz file, under their names; "shape" is the shape of
/// the matrix. @throws std::runtime_error if the file cannot be written.
void write_npz(PendingFile& file, const ViewFactors& factors);

}  // namespace interflect::detail
