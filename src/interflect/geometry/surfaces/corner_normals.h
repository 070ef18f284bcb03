#pragma once

#include <cstdint>
#include <vector>

#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// 0.5 degrees: above the rounding of normals in readers (0.2 degrees).
inline constexpr float cosine_of_flat = 0.99996f;

/// Normals with which the corners of patches are shaded. Scene::normals count where the surface bends as they do: they
/// may deviate from the mean normal of the faces that join there by at most the bend of a face towards a smooth
/// neighbour, in the direction of the deviation. Elsewhere, the mean counts. So a plane face without smooth neighbours
/// has its own normal (docs/method/method.md, Curved surfaces).
class CornerNormals {
  public:
    /// @param surfaces  Of this scene. Cost: O(n log n) for n patches.
    CornerNormals(const Scene& scene, const SmoothSurfaces& surfaces);

    /// Returns the unit normal towards the lit side; zero if the file has none there.
    const V3f& at(CornerIndex corner) const { return normals_[corner]; }

    /// Patches with a corner where the normal of the file is replaced, and deviates from the patch's by more than
    /// `degrees`; fronts only.
    std::vector<PatchIndex> contradicted_patches(const Scene& scene, float degrees) const;

  private:
    std::vector<V3f> normals_;
    std::vector<bool> is_replaced_;
};

}  // namespace interflect::detail
