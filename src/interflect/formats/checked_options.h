#pragma once

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// The options themselves. @throws InputError  where one is outside its range.
const ReadOptions& checked(const ReadOptions& options);

}  // namespace interflect::inline detail
