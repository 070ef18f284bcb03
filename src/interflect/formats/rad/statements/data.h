#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Data file of Radiance: values over one or two coordinates.
struct RadData {
    std::vector<std::vector<double>> axes;  ///< Coordinates of the values along each dimension, ascending.
    std::vector<double> values;             ///< The last dimension varies fastest.

    /// Interpolates linearly; zero outside the table.
    double at(std::span<const double> coordinates) const;
};

/// @param most  Limit of the number of values. @throws std::invalid_argument
RadData parse_rad_data(std::string_view text, std::size_t most);

}  // namespace interflect::detail
