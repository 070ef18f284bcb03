#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "interflect/ray_caster.h"

namespace interflect::detail {

enum class RayInterface { single, packet8, packet16, stream };

/// Rays in Embree's layout. Tracing them requires no conversion, so their rate is an upper bound of the solver's.
class PreparedRays {
  public:
    PreparedRays(std::span<const Ray> rays, RayInterface interface);
    ~PreparedRays();
    PreparedRays(const PreparedRays&) = delete;
    PreparedRays& operator=(const PreparedRays&) = delete;

    /// Groups have 1024 rays; the last may have fewer.
    std::size_t group_count() const;
    /// Call it once for each group, because Embree overwrites the rays.
    void trace_group(const RayCaster& ray_caster, std::size_t group);
    std::size_t hit_count() const;

  private:
    struct Layout;
    std::unique_ptr<Layout> layout_;
};

}  // namespace interflect::detail
