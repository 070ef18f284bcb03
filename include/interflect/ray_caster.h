/// @file
/// First hits of rays, by Embree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect {

namespace detail {
class PreparedRays;
class RayRecorder;
}  // namespace detail

/// A ray of unit direction. Rays that leave a patch start RayCaster::ray_offset() above it, to avoid hits in its own
/// plane.
struct Ray {
    V3f origin;
    V3f direction;
};

/// First hit of a ray.
struct Hit {
    PatchIndex patch{};  ///< Patch that was hit; none if the ray escapes.
    float distance = 0;  ///< Distance of the hit from the origin [m].
};

/// Ray tracer for a scene, based on Embree. Immutable and thread-safe.
class RayCaster {
  public:
    /// @throws InputError that lists every fault of the scene (scene_faults).
    explicit RayCaster(const Scene& scene);
    ~RayCaster();
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// Finds the first hit of every ray, on the calling thread. Rays pass through the back of one-sided faces.
    /// Coincident faces have a fixed priority: faces of smaller flat surfaces (see cut_at_contacts()), then emitters,
    /// then the order in the scene.
    /// @throws InputError unless the numbers of rays and hits are equal.
    void trace(std::span<const Ray> rays, std::span<Hit> hits) const;

    /// Height above its patch at which a ray starts [m]: 128 u c = 2^-17 c. Here c is the largest coordinate of the
    /// patch's corners, relative to the scene's origin, and u = 2^-24 the rounding of a float. The rounding errors sum
    /// to at most 24 u c: 8 u c for the start point (corners, normal, interpolation, offset), and 16 u c for Embree's
    /// robust test, which subtracts the start point from corners at a distance of up to 2 c. For coincident faces the
    /// offset is at least 4 times the distance within which they coincide, 4 u times the larger face's c: 16 u where 8
    /// are needed. Independent of all other faces.
    float ray_offset(PatchIndex patch) const { return ray_offsets_[patch]; }

    /// Fraction of a patch's area, in [0, 1], that rays can hit, and from which light may be emitted. Below 1 if
    /// coincident faces cover it.
    float uncovered_share(PatchIndex patch) const;
    /// Whether uncovered_share() is below 1 anywhere.
    bool has_covered_patches() const;

    /// @throws InputError unless this ray caster was made for a scene of the same geometry: origin, corners of patches
    ///         and pairs of sides.
    void require_made_for(const Scene& scene) const;

    /// Scene::origin: world coordinates of (0, 0, 0) in ray coordinates [m].
    const Imath::V3d& origin() const { return origin_; }

    /// Memory of the ray tracer for this scene [bytes].
    std::size_t memory() const;

  private:
    friend class detail::PreparedRays;
    friend class detail::RayRecorder;
    struct Embree;
    std::unique_ptr<Embree> embree_;
    std::uint64_t scene_fingerprint_;
    Imath::V3d origin_;
    std::vector<float> ray_offsets_;
};

}  // namespace interflect
