#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Irradiance without occluders, which is the mean of LightSources::sample(). Immutable, thread-safe. The cost is
/// linear in the number of sources, so it is available for few sources only.
class UnoccludedLight {
  public:
    /// Arguments must outlive this.
    UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry);

    /// Whether at() is available for a kind: its sources are few, and emitting patches have no texture.
    bool has(SourceKind kind) const;
    /// Whether at() uses u and v.
    bool samples_sources() const { return !lamps_.empty() || !suns_.empty(); }
    /// Whether at() has no noise.
    bool is_exact(SourceKind kind) const { return is_exact_[static_cast<std::size_t>(kind)]; }

    /// Returns the irradiance at x on a surface with normal n [as H]: exact for emitting patches (Lambert's formula for
    /// polygons), points and suns above the horizon. For other luminaires it is an unbiased estimate from 16 stratified
    /// points.
    /// @param u, v  In (0, 1), uniform: place the strata.
    Rgb at(SourceKind kind, const V3f& x, const V3f& n, float u, float v) const;

  private:
    /// Eight emitting patches. Each coordinate has an array of its own, which lets compilers generate vector code.
    struct PatchGroup {
        static constexpr std::size_t size = 8;
        using Numbers = std::array<float, size>;

        std::array<Numbers, 4> x{}, y{}, z{};  // coordinates of the corners; triangles repeat the last corner
        std::array<PatchIndex, size> patches;
        std::size_t count = 0;

        void add(const Scene& scene, PatchIndex patch);
        struct Irradiance {
            Numbers of_unit_radiance;
            std::array<std::int32_t, size>
                is_exact;  // 0 if part of a patch is below the horizon, or an edge spans a large angle
        };
        Irradiance at(const V3f& p, const V3f& n) const;
    };
    Rgb by_patches(const V3f& x, const V3f& n) const;
    float by_patch(PatchIndex patch, const V3f& x, const V3f& n) const;

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    std::vector<PatchGroup> groups_;
    std::size_t patch_count_ = 0;
    std::vector<std::uint32_t> lamps_, suns_;
    std::array<bool, source_kinds.size()> is_exact_{true, true, true};
    bool has_texture_ = false;
};

/// Returns the irradiance at x, on a surface with normal n, from a convex polygon of unit radiance. The part of the
/// polygon below the horizon does not count. The vertices may have either order.
float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n);

}  // namespace interflect::detail
