#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/scene/patch_geometry.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// What counts as one smooth surface.
struct SmoothingOptions {
    /// Patches whose normals differ by more than this do not shade into each other [degrees]. The default is wider than
    /// the 22.5 degrees between the facets of a sphere or cylinder that a reader has tessellated.
    float crease_angle = 30;
};

/// Which corners of patches meet in one point of one smooth surface, and so share one value.
struct CornerGroups {
    std::vector<std::uint32_t> group;  ///< [4 patch + corner]: 0 ... count - 1; none for a triangle's fourth corner.
    std::uint32_t count = 0;
};

/// Two corners at the same point are of one group where a chain of patches leads from one to the other, each sharing
/// with the next an edge at that point, of equal material, with no crease between them, and of one orientation (the
/// edge runs opposite ways in the two patches' vertex orders), so that fronts continue onto fronts and backs onto
/// backs. Vertices are the same where their positions are equal to rounding (2^-20 of the scene's largest coordinate).
/// A vertex in the middle of a neighbour's edge is not looked for: there shading is not continuous. Time O(n log n) in
/// the number of patches n.
CornerGroups group_corners(const Scene& scene, const SmoothingOptions& options = {});

/// One value a corner group: the mean of `values` (one a patch) over the group's corners, weighted by the angles that
/// the patches have there. An angle does not change when a patch is cut into triangles (Thuermer and Wuethrich 1998),
/// so the way in which a file happened to be tessellated leaves no mark.
std::vector<Rgb> corner_means(const Scene& scene, const CornerGroups& groups, std::span<const Rgb> values);

/// Irradiance that varies continuously over smooth surfaces: interpolated from the corners of patches, linearly on a
/// triangle and bilinearly on a quadrilateral. A patch without smooth neighbours keeps its one value.
class SmoothIrradiance {
  public:
    /// @param irradiance  One a patch, in any unit.
    /// @throws InputError where the sizes disagree.
    SmoothIrradiance(const Scene& scene, std::span<const Rgb> irradiance, const SmoothingOptions& options = {});

    /// Irradiance at a point of a patch.
    Rgb at(std::uint32_t patch, Parameters p) const;

  private:
    CornerGroups groups_;
    std::vector<Rgb> corner_value_;  // of each group
};

}  // namespace interflect
