#pragma once

#include "interflect/load.h"

namespace interflect::detail {

/// Returns `options` unchanged. @throws InputError  if an option is out of range.
const ReadOptions& checked(const ReadOptions& options);

}  // namespace interflect::detail
