#pragma once

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// Returns `options` unchanged. @throws InputError  if an option is out of range.
const ReadOptions& checked(const ReadOptions& options);

}  // namespace interflect::inline detail
