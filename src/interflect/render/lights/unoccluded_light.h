#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Irradiance without occluders, which is the mean of LightSources::sample(), by groups of near sources of a kind.
/// Immutable, thread-safe. The cost is linear in the number of sources, so it is available for few
/// sources only.
class UnoccludedLight {
  public:
    /// With more groups, too few shadow rays of near points would tell the visible share of each.
    static constexpr std::size_t max_groups_of_kind = 16, max_groups = max_groups_of_kind * source_kinds.size();

    struct Source {
        std::uint32_t index;  ///< SourceSample::index.
        V3f place{0, 0, 0};   ///< Centre [m]; of a sun, its unit direction.
    };

    /// Arguments must outlive this.
    UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry);

    /// Whether the light of a kind is available: its sources are few, and emitting patches have no texture.
    bool has(SourceKind kind) const { return is_available_[static_cast<std::size_t>(kind)]; }
    /// Whether add() uses u and v.
    bool samples_sources() const { return !luminaires_.empty(); }

    std::size_t group_count() const { return is_exact_.size(); }
    /// Returns the first group of each kind, and the end, one past its last group.
    const std::array<std::pair<std::size_t, std::size_t>, source_kinds.size()>& groups_by_kind() const {
        return groups_by_kind_;
    }
    /// Returns the group of a source. @param source  SourceSample::index, of a kind that is available.
    std::uint32_t group_of(SourceKind kind, std::uint32_t source) const {
        return (kind == SourceKind::patches ? group_of_patch_ : group_of_luminaire_)[source];
    }
    /// Whether the light of a group has no noise.
    bool is_exact(std::size_t group) const { return is_exact_[group] != 0; }

    /// Adds the irradiance at x on a surface with normal n by each group [as H]: exact for emitting patches (Lambert's
    /// formula for polygons), points and suns above the horizon. For other luminaires it is an unbiased estimate from
    /// 16 stratified points.
    /// @param u, v       In (0, 1), uniform: place the strata.
    /// @param is_needed  By group. The light of other groups is not added, or only in part.
    void add(const V3f& x, const V3f& n, float u, float v, std::span<const std::uint8_t> is_needed,
             std::span<Rgb> by_group) const;

  private:
    /// Eight emitting patches. Each coordinate has an array of its own, which lets compilers generate vector code.
    struct PatchPack {
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
    void add_groups(SourceKind kind, std::span<Source> sources);
    float by_patch(PatchIndex patch, const V3f& x, const V3f& n) const;

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    std::vector<PatchPack> patch_packs_;  // in the order of the groups
    std::vector<std::uint32_t> luminaires_;
    std::vector<std::uint32_t> group_of_patch_, group_of_luminaire_;
    std::vector<std::uint8_t> is_exact_;  // by group
    std::array<std::pair<std::size_t, std::size_t>, source_kinds.size()> groups_by_kind_{};
    std::array<bool, source_kinds.size()> is_available_{};
};

/// Returns the irradiance at x, on a surface with normal n, from a convex polygon of unit radiance. The part of the
/// polygon below the horizon does not count. The vertices may have either order.
float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n);

}  // namespace interflect::detail
