#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/view_factors.h"

namespace interflect::detail {

/// Finds the entry (j, i) for each entry (i, j) of a sparse matrix, row by row: O(entries) in total.
class Transposed {
  public:
    static constexpr std::int64_t absent = -1;

    explicit Transposed(const ViewFactors& factors)
        : factors_(factors), next_(factors.row_offsets.begin(), factors.row_offsets.end() - 1) {}

    /// Returns the index of entry (j, i), or `absent`. Calls must not decrease i.
    std::int64_t find(std::size_t i, std::size_t j) {
        std::int64_t& next = next_[j];
        const std::int64_t end = factors_.row_offsets[j + 1];
        const auto column = static_cast<std::int32_t>(i);
        while (next < end && factors_.columns[static_cast<std::size_t>(next)] < column) ++next;
        return next < end && factors_.columns[static_cast<std::size_t>(next)] == column ? next : absent;
    }

  private:
    const ViewFactors& factors_;
    std::vector<std::int64_t> next_;  // by row: first entry whose column is not below i
};

}  // namespace interflect::detail
