#pragma once

#include <cstdint>
#include <vector>

#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Minimum cosine between the normals of faces that count as flat: 0.5 degrees, because readers round normals by up to
/// 0.2 degrees.
inline constexpr float cosine_of_flat = 0.99996f;

/// Normals with which the corners of patches are shaded. Normals of Scene::normals are used if their deviation from the
/// mean normal of the faces that join there is at most the bend of a face towards a smooth neighbour, in the direction
/// of the deviation. Otherwise, the mean is used. So a plane face without smooth neighbours has its own normal
/// (docs/method/method.md, Curved surfaces).
class CornerNormals {
  public:
    /// Costs O(n log n) for n patches. @param surfaces  Smooth surfaces of this scene.
    CornerNormals(const Scene& scene, const SmoothSurfaces& surfaces);

    /// Returns the unit normal towards the lit side, or zero if the file has no normal there.
    const V3f& at(CornerIndex corner) const { return normals_[corner]; }

    /// Returns the front patches with a corner where the normal of the file is replaced and deviates from the patch's
    /// by more than `degrees`.
    std::vector<PatchIndex> contradicted_patches(const Scene& scene, float degrees) const;

  private:
    std::vector<V3f> normals_;
    std::vector<bool> is_replaced_;
};

}  // namespace interflect::detail
