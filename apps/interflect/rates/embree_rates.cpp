#include "apps/interflect/rates/embree_rates.h"

#include <fmt/format.h>

#include "interflect/base/threads/parallel.h"
#include "interflect/raycast/embree/prepared_rays.h"

namespace interflect::command {

using namespace detail;

namespace {

struct NamedInterface {
    RayInterface interface;
    const char* name;
};
constexpr std::array<NamedInterface, 4> interfaces = {{{RayInterface::single, "single"},
                                                       {RayInterface::packet8, "packet8"},
                                                       {RayInterface::packet16, "packet16"},
                                                       {RayInterface::stream, "stream"}}};

}  // namespace

EmbreeRates measure_embree(const RayCaster& ray_caster, std::span<const Ray> rays) {
    EmbreeRates rates;
    for (std::size_t i = 0; i < interfaces.size(); ++i) {
        PreparedRays prepared(rays, interfaces[i].interface);
        const double seconds = seconds_for([&] {
            parallel_for_ranges(prepared.group_count(), 1,
                                [&](std::size_t group, std::size_t) { prepared.trace_group(ray_caster, group); });
        });
        rates.by_interface[i] = static_cast<double>(rays.size()) / seconds;
    }
    return rates;
}

Json json_by_interface(const EmbreeRates& rates) {
    Json result;
    for (std::size_t i = 0; i < interfaces.size(); ++i) result[interfaces[i].name] = rates.by_interface[i];
    return result;
}

void print_rates(const Json& rates) {
    for (const auto& [interface, rate] : rates.items())
        fmt::print("  Embree alone, {:9}{:8.2f} M rays/s\n", interface, rate.get<double>() / 1e6);
}

}  // namespace interflect::command
