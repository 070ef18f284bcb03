#pragma once

#include "interflect/load.h"

namespace interflect::detail {

/// @throws InputError for options out of range.
const ReadOptions& checked(const ReadOptions& options);

}  // namespace interflect::detail
