#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene/scene.h"

namespace interflect {

/// Two faces that coincide somewhere; each named by its patch, of a two-sided one by the first.
struct FacePair {
    std::uint32_t larger, smaller;  ///< By their own areas; of equal ones the later face counts as larger.
};

/// All pairs of faces that overlap in (nearly) one plane: the smaller's polygon reaches more than `tolerance` into the
/// larger's, measured in the larger's plane, and what they share lies within `tolerance` of that plane. Not those of
/// two one-sided faces that face opposite ways: each answers rays that the other lets through.
/// @param left_out   Faces that are not looked at; size scene.patches.size().
/// @param tolerance  [m], > 0.
/// @return           In order of the larger face. O(n log n + pairs) time for n faces of bounded local density.
std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& left_out, float tolerance);

}  // namespace interflect
