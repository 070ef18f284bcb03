#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/core.h"

namespace interflect::detail {

/// 4D points in (0, 1), one array per dimension.
struct PointBlock {
    static constexpr std::size_t capacity = 1024;
    std::array<std::array<float, capacity>, 4> coordinate;
};

/// Computes points from index `first` of the sequence `key`: random, or Sobol' (Joe and Kuo 2008) with hash-based Owen
/// scrambling (Laine and Karras 2011). Each point is uniform over random keys; 2^k Sobol' points from a multiple of 2^k
/// are stratified in 4D.
/// @param count  At most PointBlock::capacity.
void fill_points(PointSet set, std::uint64_t key, std::uint64_t first, std::size_t count, PointBlock& block);

/// Returns a point of a shuffled, scrambled 4D Sobol' sequence, stratified up to 2^16 points. Different keys are
/// independent and pad to more dimensions (Burley 2020).
std::array<float, 4> shuffled_point(std::uint64_t key, std::uint32_t index);

}  // namespace interflect::detail
