#pragma once

#include <ImathBox.h>
#include <ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// A patch laid out in a plane.
struct FlatPatch {
    std::uint32_t patch;
    int count;                            ///< Of corners: 3 or 4.
    std::array<Imath::V2d, 4> corners{};  ///< In the patch's vertex order.

    std::span<const Imath::V2d> outline() const { return {corners.data(), static_cast<std::size_t>(count)}; }
    /// Where the point of the patch with these parameters is.
    Imath::V2d point(Parameters p) const;
    Imath::V2d centre() const { return point(count == 3 ? Parameters{1.0f / 3, 1.0f / 3} : Parameters{0.5f, 0.5f}); }
    double signed_area() const;  ///< Above 0 where the outline is counter-clockwise.
    Imath::Box2d box() const;
};

using FlatPatches = std::vector<FlatPatch>;

/// Patches of one plane, in a frame of that plane [m]; the lit side has its corners counter-clockwise.
FlatPatches projected(const Scene& scene, std::span<const std::uint32_t> patches);

/// The largest distance between two parallel lines that have convex outlines on different sides: at most their
/// distance, below 0 where they overlap.
double separation(const FlatPatch& a, const FlatPatch& b);

}  // namespace interflect::inline detail
