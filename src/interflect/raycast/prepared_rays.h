#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "interflect/ray_caster.h"

namespace interflect::detail {

/// Embree's interfaces for tracing rays.
enum class RayInterface { single, packet8, packet16, stream };

/// Rays in Embree's own layout, traced without conversion: the upper bound for the solver's ray rate.
class PreparedRays {
  public:
    PreparedRays(std::span<const Ray> rays, RayInterface interface);
    ~PreparedRays();
    PreparedRays(const PreparedRays&) = delete;
    PreparedRays& operator=(const PreparedRays&) = delete;

    /// Rays are traced in groups of 1024 (the last may be shorter).
    std::size_t group_count() const;
    /// Traces one group on the calling thread. Call once per group, because Embree overwrites the rays.
    void trace_group(const RayCaster& ray_caster, std::size_t group);
    /// Number of rays with a hit so far.
    std::size_t hit_count() const;

  private:
    struct Layout;
    std::unique_ptr<Layout> layout_;
};

}  // namespace interflect::detail
