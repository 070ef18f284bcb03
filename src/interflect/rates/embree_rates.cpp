#include "interflect/rates/embree_rates.h"

#include <array>
#include <cstddef>

#include "interflect/base/threads/parallel.h"
#include "interflect/raycast/embree/prepared_rays.h"

namespace interflect::detail {

namespace {

/// In the order of EmbreeRates::names.
constexpr std::array<RayInterface, 4> interfaces{RayInterface::single, RayInterface::packet8, RayInterface::packet16,
                                                 RayInterface::stream};

}  // namespace

EmbreeRates measure_embree(const RayCaster& ray_caster, std::span<const Ray> rays) {
    EmbreeRates rates;
    for (std::size_t i = 0; i < interfaces.size(); ++i) {
        PreparedRays prepared(rays, interfaces[i]);
        const double seconds = seconds_for([&] {
            parallel_for_ranges(prepared.group_count(), 1,
                                [&](std::size_t group, std::size_t) { prepared.trace_group(ray_caster, group); });
        });
        rates.by_interface[i] = static_cast<double>(rays.size()) / seconds;
    }
    return rates;
}

}  // namespace interflect::detail
