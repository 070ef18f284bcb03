#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene/sky_frame.h"

namespace interflect::detail {

/// Grid of equal azimuths and equal angles from the zenith, row by row from the zenith.
struct SkyGrid {
    std::size_t columns, rows;

    std::size_t size() const { return columns * rows; }
    /// Returns the cosine of the zenith angle at the upper edge of a row.
    double edge_cosine(std::size_t row) const;
    double solid_angle(std::size_t row) const;  ///< Per cell in the row [sr].
    SkyPlace middle(std::size_t column, std::size_t row) const;
    std::size_t row_of(float cosine) const;
    std::size_t column_of(float s) const;
};

/// Samples places by the weights of a grid's cells, uniformly in solid angle within a cell: a piecewise constant
/// distribution. Immutable; 4 bytes per cell.
class DirectionTable {
  public:
    /// @param weights  Per cell, >= 0.
    DirectionTable(const SkyGrid& grid, std::span<const float> weights);

    double sum() const { return sum_; }  ///< Sum of the weights; sampling requires > 0.
    /// For u and v uniform in (0, 1): u chooses the column, v the row.
    SkyPlace sample(float u, float v) const;
    /// Per solid angle [1/sr].
    float density(const SkyPlace& place) const;

  private:
    SkyGrid grid_;
    double sum_ = 0;
    std::vector<double> rows_;    // cumulative share of each row, from 0 to 1
    std::vector<float> columns_;  // cumulative share of each cell in its row
};

}  // namespace interflect::detail
