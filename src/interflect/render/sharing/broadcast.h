#pragma once

#include <span>

#include "interflect/ranks.h"

namespace interflect::detail {

/// Copies the values of rank 0 to all ranks. Collective.
template <class T>
void broadcast(Ranks& ranks, std::span<T> values) {
    ranks.broadcast(std::as_writable_bytes(values));
}

}  // namespace interflect::detail
