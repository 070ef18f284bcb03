#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Overlapping faces, identified by their first patches.
struct FacePair {
    std::uint32_t larger, smaller;  ///< By area; at equal areas the later face is larger.
};

/// Returns the distance within which two faces coincide [m]: the smaller face's tolerance, but at least the rounding of
/// the larger one's plane, an eighth of its tolerance.
inline float pair_tolerance(std::span<const float> tolerance, const FacePair& pair) {
    return std::max(tolerance[pair.smaller], tolerance[pair.larger] / 8);
}

/// Finds all pairs of overlapping, nearly coplanar faces. The smaller one reaches more than pair_tolerance() into the
/// larger; the common part lies within that distance of the larger one's plane. Skips one-sided faces with opposite
/// normals, which intercept different rays.
/// @param ignored    Per patch.
/// @param tolerance  Per patch [m], > 0.
/// @return           Sorted by larger face. O(n log n + pairs) for bounded local density.
std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& ignored,
                                        std::span<const float> tolerance);

}  // namespace interflect::detail
