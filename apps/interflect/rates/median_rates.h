#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "interflect/exports/records/json_text.h"
#include "interflect/rates.h"

namespace interflect::command {

/// Returns the median of a figure over the rounds of a measurement; of an even number the larger middle one.
template <class Round, class Figure>
double median_of(const std::vector<Round>& rounds, const Figure& figure) {
    std::vector<double> values(rounds.size());
    std::transform(rounds.begin(), rounds.end(), values.begin(), figure);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Computes the medians of EmbreeRates, a member `embree` of each round.
template <class Round>
EmbreeRates median_rates(const std::vector<Round>& rounds) {
    EmbreeRates result;
    for (std::size_t i = 0; i < result.by_interface.size(); ++i)
        result.by_interface[i] = median_of(rounds, [i](const Round& r) { return r.embree.by_interface[i]; });
    return result;
}

detail::Json json_by_interface(const EmbreeRates& rates);

/// @param rates  Result of json_by_interface().
void print_rates(const detail::Json& rates);

}  // namespace interflect::command
