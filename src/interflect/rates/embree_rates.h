#pragma once

#include <chrono>
#include <span>

#include "interflect/rates.h"

namespace interflect::detail {

template <class Work>
double seconds_for(const Work& work) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Traces the rays once with each interface.
EmbreeRates measure_embree(const RayCaster& ray_caster, std::span<const Ray> rays);

}  // namespace interflect::detail
