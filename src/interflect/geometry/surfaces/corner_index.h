#pragma once

#include <cstddef>
#include <cstdint>

#include "interflect/indices.h"

namespace interflect::detail {

/// A corner of a patch: 4 patch + corner, an index into vectors with four entries per patch.
struct CornerIndex {
    std::uint32_t value = none;

    constexpr CornerIndex() = default;
    constexpr CornerIndex(PatchIndex patch, std::uint32_t corner) : value(4 * patch.value + corner) {}
    constexpr explicit CornerIndex(std::size_t i) : value(static_cast<std::uint32_t>(i)) {}
    constexpr operator std::uint32_t() const { return value; }

    constexpr PatchIndex patch() const { return PatchIndex(value / 4); }
    constexpr std::uint32_t corner() const { return value % 4; }
};

/// The edge of a patch that starts at a corner.
using EdgeIndex = CornerIndex;

}  // namespace interflect::detail
