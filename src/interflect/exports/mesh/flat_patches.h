#pragma once

#include <ImathBox.h>
#include <ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// A patch in the plane of a chart.
struct FlatPatch {
    PatchIndex patch;
    int count;                            ///< Number of corners, 3 or 4.
    std::array<Imath::V2d, 4> corners{};  ///< Corners in the patch's vertex order.

    std::span<const Imath::V2d> outline() const { return {corners.data(), static_cast<std::size_t>(count)}; }
    Imath::V2d point(Parameters p) const;
    Imath::V2d centre() const { return point(count == 3 ? Parameters{1.0f / 3, 1.0f / 3} : Parameters{0.5f, 0.5f}); }
    double signed_area() const;  ///< Positive if counter-clockwise.
    Imath::Box2d box() const;
};

using FlatPatches = std::vector<FlatPatch>;

/// Projects coplanar patches to their plane [m]; they are counter-clockwise as seen from the lit side.
FlatPatches projected(const Scene& scene, std::span<const PatchIndex> patches);

/// Returns a lower bound of the distance between convex outlines; negative if they overlap.
double separation(const FlatPatch& a, const FlatPatch& b);

}  // namespace interflect::detail
