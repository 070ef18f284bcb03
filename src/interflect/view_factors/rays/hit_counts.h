#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace interflect::detail {

/// Hits of one scrambling of a group's points: columns with their number of hits, and the number of rays.
struct ReplicateHits {
    struct Column {
        std::uint32_t column, hits;
    };
    std::vector<Column> columns;  ///< In any order, each once.
    std::int64_t rays = 0;
};

/// Counts hits by column. One object per thread.
class HitCounter {
  public:
    explicit HitCounter(std::size_t columns) : hits_(columns, 0) {}

    void add(std::uint32_t column) {
        if (hits_[column]++ == 0) hit_columns_.push_back(column);
    }
    /// Moves all counts to `result`.
    void finish(ReplicateHits& result);

  private:
    std::vector<std::uint32_t> hits_;
    std::vector<std::uint32_t> hit_columns_;
};

struct EstimatedFactor {
    std::uint32_t column;
    float value, error;
};

/// Estimates the factors of a row from independent replicates: the ratio of all hits to all rays, and its standard
/// error from the spread of the replicates (see view_factors()).
/// @return  Columns with hits, in increasing order. Empty without rays.
std::vector<EstimatedFactor> estimate_row(std::span<const ReplicateHits> replicates);

}  // namespace interflect::detail
