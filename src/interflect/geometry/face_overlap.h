#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Two overlapping faces, each identified by its (first) patch.
struct FacePair {
    std::uint32_t larger, smaller;  ///< By area; of equal faces the later one counts as larger.
};

/// Distance within which two faces coincide [m]: the tolerance of the smaller face. The larger face contributes only
/// the rounding of its corners, an eighth of its tolerance, which moves its plane.
inline float pair_tolerance(std::span<const float> tolerance, const FacePair& pair) {
    return std::max(tolerance[pair.smaller], tolerance[pair.larger] / 8);
}

/// Finds all pairs of faces that overlap in (nearly) one plane: the smaller polygon reaches more than pair_tolerance()
/// into the larger one, and the common part is within that distance of the larger one's plane. Skips pairs of one-sided
/// faces with opposite normals, which intercept different rays.
/// @param ignored    Faces to ignore; size scene.patches.size().
/// @param tolerance  Tolerance of each face [m], > 0; size scene.patches.size().
/// @return           In order of the larger face. O(n log n + pairs) time for n faces of bounded local density.
std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& ignored,
                                        std::span<const float> tolerance);

}  // namespace interflect::detail
