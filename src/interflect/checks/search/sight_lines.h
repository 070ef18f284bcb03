#pragma once

#include <cstdint>

#include "interflect/raycast/panes.h"

namespace interflect::detail {

/// Traces lines of sight through panes. Random directions depend on key and index alone.
class SightLines {
  public:
    SightLines(const Scene& scene, const RayCaster& ray_caster);

    /// Returns the first hit beyond panes, with its distance from the start.
    Hit first_surface(const Ray& ray) const;

    /// Whether only panes separate two points, in either direction.
    bool is_clear(const V3f& a, const V3f& b) const;

    struct RayOutcomes {
        int escaped = 0, hits = 0;
        float distance_sum = 0;  ///< [m]
    };
    static constexpr int rays_per_point = 32;
    /// Traces rays from a surface until more than `max_escaped` escape.
    RayOutcomes trace_from_surface(const V3f& x, const V3f& normal, std::uint64_t key, int max_escaped) const;
    /// Whether a quarter of all directions escape, as outside a closed scene.
    bool is_open(const V3f& x) const;

    static V3f uniform_direction(std::uint64_t key, std::uint64_t index);
    static V3f cosine_direction(const V3f& normal, std::uint64_t key, std::uint64_t index);

  private:
    const RayCaster& ray_caster_;
    Panes panes_;
};

}  // namespace interflect::detail
