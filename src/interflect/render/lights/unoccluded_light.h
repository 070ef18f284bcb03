#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Irradiance without occluders: the mean of LightSources::sample(). Immutable, thread-safe. Cost: linear in the
/// sources, hence only for few.
class UnoccludedLight {
  public:
    /// Arguments must outlive this.
    UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry);

    /// Whether the sources of a kind are few. Emitting patches must be without texture.
    bool has(SourceKind kind) const;

    /// Returns the irradiance at x on a surface with normal n [as H]: exact for emitting patches (Lambert's formula for
    /// polygons), points and suns above the horizon. For other luminaires it is an unbiased estimate from 16 stratified
    /// points.
    /// @param u, v  In (0, 1), uniform: place the strata.
    Rgb at(SourceKind kind, const V3f& x, const V3f& n, float u, float v) const;

  private:
    Rgb by_patches(const V3f& x, const V3f& n) const;

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    std::vector<std::uint32_t> patches_, lamps_, suns_;
    bool has_texture_ = false;
};

/// Returns the irradiance at x on a surface with normal n by the part above it of a convex polygon of unit radiance, in
/// either vertex order.
float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n);

}  // namespace interflect::detail
