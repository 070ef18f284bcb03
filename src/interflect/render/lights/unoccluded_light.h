#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Exact irradiance without occluders; shadow rays then estimate only its visible share. Immutable, thread-safe. Cost:
/// linear in the sources, hence only for few.
class UnoccludedLight {
  public:
    /// Arguments must outlive this.
    UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry);

    /// Whether all emitting patches (luminaires but skies) are few and have a closed form.
    bool has_patches() const { return has_patches_; }
    bool has_luminaires() const { return has_luminaires_; }

    /// Returns the irradiance [as H] at x on a surface with normal n, by Lambert's formula for polygons.
    /// @param own  The patch below x, which does not count; may be `none`.
    Rgb by_patches(const V3f& x, const V3f& n, std::uint32_t own) const;
    /// Measured luminaires: the mean over 16 points of the opening.
    Rgb by_luminaires(const V3f& x, const V3f& n) const;

  private:
    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    std::vector<std::uint32_t> patches_, luminaires_;
    bool has_patches_ = false, has_luminaires_ = false;
};

/// Returns the irradiance at x on a surface with normal n by the part above it of a convex polygon of unit radiance, in
/// either vertex order.
float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n);

}  // namespace interflect::detail
