#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/view_factors.h"

namespace interflect::detail {

/// Exchange areas X_ij = A_i F_ij [m^2] with their variances, as a sparse matrix. It is symmetric to the last bit if
/// the two directions of each pair were averaged.
struct ExchangeAreas {
    static constexpr std::size_t others = 3;  ///< Sky, ground and blocked.
    /// Tasks take milliseconds, even for rows of thousands of entries.
    static constexpr std::size_t rows_per_task = 64;

    std::vector<std::int64_t> row_offsets;
    std::vector<std::int32_t> columns;
    std::vector<float> values, variances;
    std::array<std::vector<double>, others> other_values, other_variances;  ///< By group.

    std::size_t size() const { return row_offsets.size() - 1; }
    std::size_t begin(std::size_t row) const { return static_cast<std::size_t>(row_offsets[row]); }
    std::size_t end(std::size_t row) const { return static_cast<std::size_t>(row_offsets[row + 1]); }
};

/// Converts factors without averaging the two directions of a pair.
ExchangeAreas directed_exchange(const ViewFactors& factors);

/// Averages both directions of each pair, with weights 1 / (A_i (1 - F_ij)): the inverse of the variance of independent
/// hits with the pair's common X. Weights from each direction's own hits would favour the lower count.
ExchangeAreas symmetric_exchange(const ViewFactors& factors);

}  // namespace interflect::detail
