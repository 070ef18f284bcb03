#include "interflect/view_factors/rays/hit_counts.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

void HitCounter::finish(ReplicateHits& result) {
    result.columns.clear();
    result.columns.reserve(hit_columns_.size());
    for (const std::uint32_t column : hit_columns_) {
        result.columns.push_back({column, hits_[column]});
        hits_[column] = 0;
    }
    hit_columns_.clear();
}

std::vector<EstimatedFactor> estimate_row(std::span<const ReplicateHits> replicates) {
    struct CountedHits {
        std::uint32_t column, hits;
        double rays;  // of the replicate
    };
    std::vector<CountedHits> counted;
    double rays = 0, rays_squared = 0;
    for (const ReplicateHits& replicate : replicates) {
        const auto n = static_cast<double>(replicate.rays);
        for (const auto& [column, hits] : replicate.columns) counted.push_back({column, hits, n});
        rays += n;
        rays_squared += n * n;
    }
    // Sums of integers are exact in any order.
    std::sort(counted.begin(), counted.end(),
              [](const CountedHits& a, const CountedHits& b) { return a.column < b.column; });
    const auto count = static_cast<double>(replicates.size());
    constexpr double resolution = 1;  // variance of a count that does not vary among the replicates
    std::vector<EstimatedFactor> row;
    for (std::size_t begin = 0; begin < counted.size();) {
        double hits = 0, hits_squared = 0, hits_by_rays = 0;
        std::size_t end = begin;
        for (; end < counted.size() && counted[end].column == counted[begin].column; ++end) {
            const double h = counted[end].hits;
            hits += h;
            hits_squared += h * h;
            hits_by_rays += h * counted[end].rays;
        }
        const double value = hits / rays;
        // Sum of (h - F n)^2, for the variance of a ratio.
        const double squares = std::max(0.0, hits_squared - 2 * value * hits_by_rays + value * value * rays_squared);
        const double variance = squares * count / (count - 1) + resolution;
        row.push_back(
            {counted[begin].column, static_cast<float>(value), static_cast<float>(std::sqrt(variance) / rays)});
        begin = end;
    }
    return row;
}

}  // namespace interflect::detail
