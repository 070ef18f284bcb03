#pragma once

#include "interflect/load.h"

namespace interflect::detail {

/// @return  `options`. @throws InputError if one is out of range.
const ReadOptions& checked(const ReadOptions& options);

}  // namespace interflect::detail
