#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "interflect/scene/scene.h"

namespace interflect {

/// A ray of unit direction. One that leaves a surface starts RayCaster::lift() above it, so that it cannot hit what
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
    explicit RayCaster(const Scene& scene);
    ~RayCaster();
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// Finds the first hit of every ray, on the calling thread; hits.size() == rays.size(). The back of a one-sided
    /// face lets a ray through. Of faces that coincide always the same one answers, seen from wherever (see
    /// coincident.h).
    void trace(std::span<const Ray> rays, std::span<Hit> hits) const;

    /// How far above its surface a ray starts [m]: 2^-17 of the largest coordinate, a few roundings of a float.
    float lift() const { return lift_; }

    /// Bytes that the ray tracer holds for this scene.
    std::size_t memory() const;

  private:
    friend class PreparedRays;
    struct Embree;
    std::unique_ptr<Embree> embree_;
    float lift_ = 0;
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
