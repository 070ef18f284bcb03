#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <random>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"

namespace interflect::detail {

/// Samples the calls of RayCaster::trace() during its lifetime, for measurements with the rays of real work. Calls are
/// kept whole, because rays of one call share a part of the scene. Each call has the same probability.
class RayRecorder {
  public:
    /// @param ray_caster  Must outlive this; has no other recorder.
    /// @param max_rays    Maximum number of kept rays, > 0; a single longer call is kept, too.
    RayRecorder(const RayCaster& ray_caster, std::size_t max_rays);
    ~RayRecorder();
    RayRecorder(const RayRecorder&) = delete;
    RayRecorder& operator=(const RayRecorder&) = delete;

    /// Thread-safe.
    void record(std::span<const Ray> rays);

    std::int64_t traced() const { return traced_; }  ///< Number of all traced rays.
    std::vector<Ray> kept() const;                   ///< Sampled rays, call by call.

  private:
    void keep_half();

    const RayCaster& ray_caster_;
    std::size_t max_rays_;
    std::mutex mutex_;
    std::minstd_rand random_;
    double probability_ = 1;
    std::int64_t traced_ = 0;
    std::size_t kept_rays_ = 0;
    std::vector<std::vector<Ray>> calls_;
};

}  // namespace interflect::detail
