#include "interflect/solver/sampling/start_points.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <tuple>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// Mean number of points in a bucket; a bucket with more has a single leaf.
constexpr std::size_t points_of_bucket = 4;
constexpr std::size_t buckets_per_task = 1024;

/// Returns x in [0, 1], quantised to 16 bits, which occupy the even bits of the result.
std::uint32_t spread_bits(float x) {
    auto bits = static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1.0f) * 65535.0f);
    bits = (bits | bits << 8) & 0x00ff00ffu;
    bits = (bits | bits << 4) & 0x0f0f0f0fu;
    bits = (bits | bits << 2) & 0x33333333u;
    return (bits | bits << 1) & 0x55555555u;
}

bool is_before(const StartPoint& a, const StartPoint& b) {
    return std::tie(a.leaf, a.place_on_curve, a.at.u, a.at.v, a.power) <
           std::tie(b.leaf, b.place_on_curve, b.at.u, b.at.v, b.power);
}

}  // namespace

StartPoint::StartPoint(std::uint32_t of_leaf, float of_power, const Parameters& point)
    : leaf(of_leaf), power(of_power), at(point), place_on_curve(spread_bits(point.u) | spread_bits(point.v) << 1) {}

StartPoints::StartPoints(std::span<const std::vector<StartPoint>* const> lists, std::uint32_t leaf_end) {
    const auto for_each_point = [&](const auto& body) {
        for (const std::vector<StartPoint>* list : lists)
            parallel_for_indices(list->size(), [&](std::size_t i) { body((*list)[i]); });
    };
    std::size_t count = 0;
    for (const std::vector<StartPoint>* list : lists) count += list->size();
    if (count == 0) return;

    // Sort into buckets of adjacent leaves
    const std::uint32_t last_leaf = leaf_end - 1;
    while (bucket_of(last_leaf) + 1 > std::max<std::size_t>(1, count / points_of_bucket)) ++bucket_shift_;
    first_.resize(bucket_of(last_leaf) + 2);
    for_each_point([&](const StartPoint& p) {
        std::atomic_ref(first_[bucket_of(p.leaf)]).fetch_add(1, std::memory_order_relaxed);
    });
    std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
    // The ends of the buckets move down to their beginnings
    points_.resize(count);
    for_each_point([&](const StartPoint& p) {
        points_[std::atomic_ref(first_[bucket_of(p.leaf)]).fetch_sub(1, std::memory_order_relaxed) - 1] = p;
    });

    // Sort each bucket, and accumulate the power of its leaves
    parallel_for_ranges(first_.size() - 1, buckets_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::span<StartPoint> sorted = bucket(i);
            std::sort(sorted.begin(), sorted.end(), is_before);
            double sum = 0;  // a float would lose small terms
            for (std::size_t k = 0; k < sorted.size(); ++k) {
                if (k == 0 || sorted[k].leaf != sorted[k - 1].leaf) sum = 0;
                sum += static_cast<double>(sorted[k].power);
                sorted[k].power = static_cast<float>(sum);
            }
        }
    });
}

std::span<const StartPoint> StartPoints::of(ElementIndex leaf) const {
    if (bucket_of(leaf) + 1 >= first_.size()) return {};
    const auto is_below = [](const StartPoint& p, std::uint32_t l) { return p.leaf < l; };
    const std::span<const StartPoint> near = bucket(bucket_of(leaf));
    const auto begin = std::lower_bound(near.begin(), near.end(), leaf, is_below);
    const auto end = std::lower_bound(begin, near.end(), leaf + 1, is_below);
    return {begin, end};
}

Parameters StartPoints::choose(std::span<const StartPoint> points, float u) {
    const float wanted = u * points.back().power;
    const auto found = std::upper_bound(points.begin(), points.end(), wanted,
                                        [](float x, const StartPoint& p) { return x < p.power; });
    return found == points.end() ? points.back().at : found->at;
}

}  // namespace interflect::detail
