#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Two faces, each identified by its first patch.
struct FacePair {
    std::uint32_t larger, smaller;  ///< The larger one has the larger area, or comes later if the areas are equal.
};

/// Returns the distance within which two faces coincide [m]. An eighth of the larger face's tolerance covers the
/// rounding of its plane.
inline float pair_tolerance(std::span<const float> tolerance, const FacePair& pair) {
    return std::max(tolerance[pair.smaller], tolerance[pair.larger] / 8);
}

/// Limits of the number of pairs. Correct scenes have far fewer, because a face that lies on a large one forms a pair
/// only with that one.
inline constexpr std::size_t free_overlaps = 1'000'000, max_overlaps_per_patch = 50;

/// Finds pairs whose smaller face reaches more than pair_tolerance() into the larger, within that distance of its
/// plane. Skips one-sided faces with opposite normals, which intercept different rays. Sorted by larger face.
/// @param tolerance  Per patch [m], > 0. @param ignored  Per patch.
/// @throws InputError for more than free_overlaps + max_overlaps_per_patch * patches pairs.
std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& ignored,
                                        std::span<const float> tolerance);

}  // namespace interflect::detail
