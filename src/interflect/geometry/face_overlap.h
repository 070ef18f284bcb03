#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Two faces that coincide somewhere; each named by its patch, of a two-sided one by the first.
struct FacePair {
    std::uint32_t larger, smaller;  ///< By area; of equal ones the later face counts as larger.
};

/// Within what distance two faces lie in one place [m]: the tolerance of the smaller one, where the two are compared;
/// of the larger one only what moves its plane, the rounding of its corners, an eighth of its tolerance.
inline float pair_tolerance(std::span<const float> tolerance, const FacePair& pair) {
    return std::max(tolerance[pair.smaller], tolerance[pair.larger] / 8);
}

/// All pairs of faces that overlap in (nearly) one plane: the smaller's polygon reaches more than pair_tolerance()
/// into the larger's, measured in the larger's plane, and what they share lies within it of that plane. Not those of
/// two one-sided faces that face opposite ways: each answers rays that the other lets through.
/// @param ignored   Faces that are ignored; size scene.patches.size().
/// @param tolerance  Of each face [m], > 0; size scene.patches.size().
/// @return           In order of the larger face. O(n log n + pairs) time for n faces of bounded local density.
std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& ignored,
                                        std::span<const float> tolerance);

}  // namespace interflect::inline detail
