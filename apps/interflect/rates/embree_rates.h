#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "interflect/exports/records/json_text.h"
#include "interflect/ray_caster.h"

namespace interflect::command {

template <class Work>
double seconds_for(const Work& work) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the median of a figure over the rounds of a measurement; of an even number the larger middle one.
template <class Round, class Figure>
double median_of(const std::vector<Round>& rounds, const Figure& figure) {
    std::vector<double> values(rounds.size());
    std::transform(rounds.begin(), rounds.end(), values.begin(), figure);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Rates of Embree alone: rays prepared in its own layout, on all threads.
struct EmbreeRates {
    std::array<double, 4> by_interface{};  ///< [rays/s] Of RayInterface.

    double ceiling() const { return *std::max_element(by_interface.begin(), by_interface.end()); }
};

EmbreeRates measure_embree(const RayCaster& ray_caster, std::span<const Ray> rays);

/// Computes the medians of EmbreeRates, a member `embree` of each round.
template <class Round>
EmbreeRates median_rates(const std::vector<Round>& rounds) {
    EmbreeRates result;
    for (std::size_t i = 0; i < result.by_interface.size(); ++i)
        result.by_interface[i] = median_of(rounds, [i](const Round& r) { return r.embree.by_interface[i]; });
    return result;
}

detail::Json json_by_interface(const EmbreeRates& rates);

/// @param rates  As of json_by_interface().
void print_rates(const detail::Json& rates);

}  // namespace interflect::command
