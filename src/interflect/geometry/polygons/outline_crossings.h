#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Whether more than `most` pairs of edges cross each other, seen along the normal. Crossings at corners do not count.
/// The cost is at worst proportional to the square of the number of edges, 1 ms for 1,024 edges, and O(n log(n)) for
/// round outlines.
bool has_more_crossings(const Scene& scene, std::span<const std::vector<std::uint32_t>> loops, const V3f& normal,
                        std::size_t most);

}  // namespace interflect::detail
