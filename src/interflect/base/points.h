#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/core.h"

namespace interflect::detail {

/// Coordinates of 4D points in (0, 1), one array per dimension for vectorisation.
struct PointBlock {
    static constexpr std::size_t capacity = 1024;
    std::array<std::array<float, capacity>, 4> coordinate;
};

/// Computes points first ... first + count - 1 of the sequence `key`; count <= PointBlock::capacity. Each point is
/// uniform over random keys; 2^k consecutive Sobol' points from a multiple of 2^k are stratified in 4D.
/// Sobol' 1967 with the direction numbers of Joe and Kuo 2008; scrambling by hashing after Laine and Karras 2011.
void fill_points(PointSet set, std::uint64_t key, std::uint64_t first, std::size_t count, PointBlock& block);

/// One 4D Sobol' point in (0, 1) of a shuffled and scrambled sequence. Points of equal index and different keys are
/// independent, so sequences can be combined into more dimensions (padding, Burley 2020). Each point is uniform over
/// the keys; 2^k <= 2^16 consecutive points from a multiple of 2^k are stratified in 4D.
std::array<float, 4> shuffled_point(std::uint64_t key, std::uint32_t index);

}  // namespace interflect::detail
