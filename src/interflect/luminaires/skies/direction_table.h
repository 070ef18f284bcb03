#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene/sky/sky_frame.h"

namespace interflect::detail {

/// Grid of equal azimuth and zenith angle steps, row by row from the zenith.
struct SkyGrid {
    std::size_t columns, rows;

    std::size_t size() const { return columns * rows; }
    /// Returns the cosine at a row's upper edge.
    double edge_cosine(std::size_t row) const;
    double solid_angle(std::size_t row) const;  ///< Per cell in the row [sr].
    SkyPlace middle(std::size_t column, std::size_t row) const;
    std::size_t row_of(float cosine) const;
    std::size_t column_of(float s) const;
};

/// Samples directions: cells by weight, uniform in solid angle within a cell. Immutable.
class DirectionTable {
  public:
    /// @param weights  Per cell, >= 0.
    DirectionTable(const SkyGrid& grid, std::span<const float> weights);

    double sum() const { return sum_; }  ///< Must be > 0 to sample.
    /// @param u, v  For column and row, in (0, 1).
    SkyPlace sample(float u, float v) const;
    /// Returns the probability density of sample() [1/sr].
    float density(const SkyPlace& place) const;

  private:
    SkyGrid grid_;
    double sum_ = 0;
    std::vector<double> rows_;    // cumulative, from 0 to 1
    std::vector<float> columns_;  // cumulative within each row
};

}  // namespace interflect::detail
