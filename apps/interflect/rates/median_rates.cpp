#include "apps/interflect/rates/median_rates.h"

#include <fmt/format.h>

namespace interflect::command {

using namespace detail;

Json json_by_interface(const EmbreeRates& rates) {
    Json result;
    for (std::size_t i = 0; i < EmbreeRates::names.size(); ++i) result[EmbreeRates::names[i]] = rates.by_interface[i];
    return result;
}

void print_rates(const Json& rates) {
    for (const auto& [interface, rate] : rates.items())
        fmt::print("  Embree alone, {:9}{:8.2f} M rays/s\n", interface, rate.get<double>() / 1e6);
}

}  // namespace interflect::command
