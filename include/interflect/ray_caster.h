#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect {

/// A ray of unit direction. One that leaves a patch starts RayCaster::ray_offset() above it, so that it cannot hit what
/// lies in the plane that it comes from.
struct Ray {
    V3f origin;
    V3f direction;
};

/// What a ray meets first.
struct Hit {
    std::uint32_t patch = none;  ///< The side that was hit; none where the ray escapes.
    float distance = 0;          ///< [m]
};

/// The scene as the ray tracer holds it: Embree behind one small interface. Immutable, shared by all threads.
class RayCaster {
  public:
    /// @throws InputError that lists every fault of the scene (scene_faults).
    explicit RayCaster(const Scene& scene);
    ~RayCaster();
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// Finds the first hit of every ray, on the calling thread. The back of a one-sided face lets a ray through. Of
    /// faces that coincide always the same one answers, seen from wherever (see coincident.h).
    /// @throws InputError unless there are as many hits as rays.
    void trace(std::span<const Ray> rays, std::span<Hit> hits) const;

    /// The ray offset: how far above its patch a ray starts [m]. With c the largest coordinate of the patch's own
    /// corners, relative to the scene's origin, and u = 2^-24 the rounding of a float, the start point is off its plane
    /// by at most 8 u c (corners, normal, interpolation, the offset itself), and Embree's robust test, which subtracts
    /// the start point from the corners, by at most 8 u times their distance, 2 c at the farthest: 24 u c in all. The
    /// offset is 128 u c = 2^-17 c. Where faces coincide, it is at least 4 times the distance within which they do,
    /// pair_tolerance(), which is 4 u of the larger one's c: 16 u where 8 are needed. What other faces there are, and
    /// where, does not matter.
    float ray_offset(std::uint32_t patch) const { return ray_offsets_[patch]; }

    /// The share of a patch's area, in [0, 1], that any ray can hit: below 1 where other faces that coincide with it
    /// answer in its place. Only that much of it may emit.
    float uncovered_share(std::uint32_t patch) const;
    /// Whether uncovered_share() is below 1 anywhere.
    bool has_covered_patches() const;

    /// @throws InputError unless this ray caster was made for a scene of the same geometry (geometry_fingerprint).
    void require_made_for(const Scene& scene) const;

    /// Scene::origin: world coordinates of what rays have as (0, 0, 0) [m].
    const Imath::V3d& origin() const { return origin_; }

    /// Bytes that the ray tracer holds for this scene.
    std::size_t memory() const;

  private:
    friend class PreparedRays;
    struct Embree;
    std::unique_ptr<Embree> embree_;
    std::uint64_t scene_fingerprint_;
    Imath::V3d origin_;
    std::vector<float> ray_offsets_;
};

/// The ways in which Embree takes rays.
enum class RayInterface { single, packet8, packet16, stream };

/// Rays that already lie in Embree's own layout, so that tracing them costs what Embree costs and nothing else: the
/// ceiling that the solver's speed is measured against.
class PreparedRays {
  public:
    PreparedRays(std::span<const Ray> rays, RayInterface interface);
    ~PreparedRays();
    PreparedRays(const PreparedRays&) = delete;
    PreparedRays& operator=(const PreparedRays&) = delete;

    /// Rays are traced in groups of 1024 (the last may be shorter).
    std::size_t group_count() const;
    /// Traces one group on the calling thread; once only, since Embree overwrites the rays.
    void trace_group(const RayCaster& ray_caster, std::size_t group);
    /// Rays that have hit something so far.
    std::size_t hit_count() const;

  private:
    struct Layout;
    std::unique_ptr<Layout> layout_;
};

}  // namespace interflect
