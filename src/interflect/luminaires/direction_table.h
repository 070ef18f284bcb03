#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene/sky_frame.h"

namespace interflect::inline detail {

/// Cells of equal azimuths and equal angles from the zenith, row by row from the zenith.
struct SkyGrid {
    std::size_t columns, rows;

    std::size_t size() const { return columns * rows; }
    /// Cosine of the angle of the upper edge of a row.
    double edge_cosine(std::size_t row) const;
    double solid_angle(std::size_t row) const;  ///< Of each of its cells [sr].
    SkyPlace middle(std::size_t column, std::size_t row) const;
    std::size_t row_of(float cosine) const;
    std::size_t column_of(float s) const;
};

/// Places in proportion to given weights of a grid's cells, uniform in solid angle within each: a piecewise-constant
/// distribution in two dimensions. Immutable; 4 bytes a cell.
class DirectionTable {
  public:
    /// @param weights  Of each cell, >= 0.
    DirectionTable(const SkyGrid& grid, std::span<const float> weights);

    double sum() const { return sum_; }  ///< Of all weights; where it is 0 there is nothing to sample.
    /// For u and v uniform in (0, 1): u chooses the column, v the row.
    SkyPlace sample(float u, float v) const;
    /// Density of sample() per solid angle [1/sr].
    float density(const SkyPlace& place) const;

  private:
    SkyGrid grid_;
    double sum_ = 0;
    std::vector<double> rows_;    // cumulative share of each row, from 0 to 1
    std::vector<float> columns_;  // of each row: its cells' cumulative shares of it, up to each cell's end
};

}  // namespace interflect::inline detail
