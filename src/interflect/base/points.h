#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/point_set.h"

namespace interflect::inline detail {

/// Coordinates of consecutive 4D points, one array a dimension, so that what follows can be vectorised; all in (0, 1).
struct PointBlock {
    static constexpr std::size_t capacity = 1024;
    std::array<std::array<float, capacity>, 4> coordinate;
};

/// Points first ... first + count - 1 of the sequence that `key` names; count <= PointBlock::capacity. Any two threads
/// that ask for the same point get the same one. Each point by itself is uniform over the random choice of keys; 2^k
/// consecutive Sobol' points that start at a multiple of 2^k are stratified in 4D.
/// Sobol' 1967 with the direction numbers of Joe and Kuo 2008; scrambling by hashing after Laine and Karras 2011.
void fill_points(PointSet set, std::uint64_t key, std::uint64_t first, std::size_t count, PointBlock& block);

/// One 4D Sobol' point of a sequence that is shuffled as well as scrambled: points of the same index and different keys
/// are independent, so several sequences together make points of more dimensions (padding, Burley 2020). Coordinates in
/// (0, 1). Each point by itself is uniform over the keys; 2^k <= 2^16 consecutive ones from a multiple of 2^k are
/// stratified in 4D.
std::array<float, 4> shuffled_point(std::uint64_t key, std::uint32_t index);

}  // namespace interflect::inline detail
