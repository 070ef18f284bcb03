#include "interflect/solver/shrinkage/cluster_shrinkage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "interflect/base/parallel.h"
#include "interflect/core.h"

namespace interflect::detail {

namespace {

/// Contributions of a part, found or expected, at which its measured variance has weight 1/2. With fewer, parts tend to
/// the variance that their area and the mean of the cluster suggest: one without any would seem to be exactly black.
constexpr double contributions_of_half_trust = 8;
/// In a region of the pictures that keeps its mean. Fewer would bring noise of the unreduced light back.
constexpr double fewest_camera_rays = 1024;
constexpr std::size_t clusters_per_task = 1 << 10;

struct Sums {
    double area = 0, power = 0;  // [m^2], luminance of the received power
    double variance = 0;         // of the power

    explicit Sums(double a = 0, double p = 0, double v = 0) : area(a), power(p), variance(v) {}
    Sums& operator+=(const Sums& o) {
        area += o.area, power += o.power, variance += o.variance;
        return *this;
    }
    double mean() const { return power / area; }
    double payload() const { return variance / power; }
    double contributions() const { return variance > 0 ? power * power / variance : 0; }
};

/// Returns the variance of a part's mean. @param least_payload  Of the cluster's parts.
double variance_of(const Sums& part, double cluster_mean, double least_payload) {
    const bool is_known = part.power > 0 && part.variance > 0;
    const double payload = is_known ? part.payload() : least_payload;
    const double expected = cluster_mean * part.area / payload,
                 contributions = std::max(part.contributions(), expected),
                 measured = contributions / (contributions + contributions_of_half_trust);
    return (measured * part.variance / part.area + (1 - measured) * payload * cluster_mean) / part.area;
}

struct Sample {
    double value, variance;
};

/// Estimates the variance of the true values (Paule and Mandel, Consensus values and weighting factors, 1982): the
/// least with which the samples' deviations from their weighted mean are as large as expected. Precise samples decide.
double variance_of_true_values(std::span<const Sample> samples) {
    const auto excess = [&](double signal) {
        double weights = 0, mean = 0, sum = 0;
        for (const auto& [value, variance] : samples)
            weights += 1 / (signal + variance), mean += value / (signal + variance);
        mean /= weights;
        for (const auto& [value, variance] : samples) sum += (value - mean) * (value - mean) / (signal + variance);
        return sum - static_cast<double>(samples.size() - 1);
    };
    if (!(excess(0) > 0)) return 0;
    const auto [least, most] = std::ranges::minmax(samples, {}, &Sample::value);
    double low = 0, high = (most.value - least.value) * (most.value - least.value);  // excess(high) <= 0
    constexpr int halvings = 20;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (low + high) / 2;
        (excess(middle) > 0 ? low : high) = middle;
    }
    return high;
}

/// Patches that share a mean of the pictures.
struct Region {
    double share = 0, area = 0;  // of the pictures; [m^2]
    RgbD before{0, 0, 0};        // in the pictures
    // After the reduction, in the pictures and over the area, and weighted by visibility():
    RgbD after{0, 0, 0}, after_visible{0, 0, 0}, power{0, 0, 0}, power_visible{0, 0, 0};

    /// 1 for patches that are seen at least as well as the region on average.
    double visibility(double seen) const { return std::min(1.0, seen * area / share); }

    void add(double seen, double patch_area, const RgbD& unreduced, const RgbD& reduced) {
        if (!(share > 0)) return;
        before += seen * patch_area * unreduced, after += seen * patch_area * reduced;
        power += patch_area * reduced;
        after_visible += visibility(seen) * seen * patch_area * reduced;
        power_visible += visibility(seen) * patch_area * reduced;
    }

    /// Returns 1 + x (visibility - y), which keeps the power and makes `after` equal to `before`. Where little is
    /// hidden, y = 0.
    float factor(double seen, int c) const {
        constexpr double most = 0.5;  // change of hidden patches
        const auto change = [&](double y) { return (before[c] - after[c]) / (after_visible[c] - y * after[c]); };
        if (!(after_visible[c] > 0)) return 1;
        double y = power_visible[c] / power[c];
        if (!(std::abs(y * change(y)) <= most)) y = 0;
        return static_cast<float>(std::max(0.0, 1 + change(y) * (visibility(seen) - y)));
    }
};

}  // namespace

ClusterShrinkage::ClusterShrinkage(const SolverState& state, const PatchClusters& clusters,
                                   std::span<const Rgb> irradiance)
    : state_(&state), clusters_(&clusters), irradiance_(irradiance), parts_(clusters.nodes().size()) {
    measure_parts();
}

std::vector<Rgb> ClusterShrinkage::means() const {
    std::vector<Rgb> means = reduce();
    keep_means_of_pictures(means);
    return means;
}

void ClusterShrinkage::measure_parts() {
    const SolverState& state = *state_;
    const ElementForest& forest = *state.forest;
    const std::vector<Sums> sums = clusters_->sums<Sums>([&](std::uint32_t p) {
        const double area = forest.area(p), all = luminance(state.solution.irradiance[p]),
                     h = luminance(irradiance_[p]);
        const double of_all =
            state.noise.variance(forest, state.solution.irradiance, p, std::max(state.history[p], 1.0f));
        const double variance = all > 0 ? of_all * std::clamp(h / all, 0.0, 1.0) : 0;  // fewer of the same rays
        return Sums(area, area * h, area * area * variance);
    });
    parts_[0].variance = static_cast<float>(sums[0].variance / (sums[0].area * sums[0].area));
    parallel_for_ranges(sums.size(), clusters_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Sample> samples;
        for (std::size_t i = begin; i < end; ++i) {
            const auto [first, count] = clusters_->nodes()[i];
            if (first == none) continue;
            for (std::uint32_t k = first; k < first + count; ++k)
                parts_[k].share = static_cast<float>(sums[k].area / sums[i].area);
            if (!(sums[i].variance > 0 && sums[i].power > 0)) continue;
            double least_payload = sums[i].payload();
            for (std::uint32_t k = first; k < first + count; ++k)
                if (sums[k].variance > 0) least_payload = std::min(least_payload, sums[k].payload());
            samples.clear();
            for (std::uint32_t k = first; k < first + count; ++k)
                samples.push_back({sums[k].mean(), variance_of(sums[k], sums[i].mean(), least_payload)});
            const double signal = variance_of_true_values(samples);
            for (std::uint32_t k = 0; k < count; ++k) {
                Part& part = parts_[first + k];
                part.variance = static_cast<float>(samples[k].variance), part.signal = static_cast<float>(signal);
                part.kept = static_cast<float>(signal / (signal + samples[k].variance));
            }
        }
    });
}

/// From the scene to the patches.
std::vector<Rgb> ClusterShrinkage::reduce() const {
    std::vector<Rgb> means(irradiance_.begin(), irradiance_.begin() + clusters_->patch_count());
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    std::vector<Rgb> before(nodes.size(), Rgb(0));
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const auto [first, count] = nodes[i];
        if (first == none)
            before[i] = irradiance_[count];
        else
            for (std::uint32_t k = first; k < first + count; ++k) before[i] += parts_[k].share * before[k];
    }
    std::vector<Rgb> after(nodes.size());
    after[0] = before[0];
    std::array<Rgb, PatchClusters::most_parts> differences;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count] = nodes[i];
        if (first == none) {
            means[count] = after[i];
            continue;
        }
        Rgb excess(0);
        float uncertainty = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            const Part& part = parts_[first + k];
            differences[k] = part.kept * (before[first + k] - after[i]);
            excess += part.share * differences[k];
            uncertainty += part.share * part.kept * part.variance;
        }
        for (std::uint32_t k = 0; k < count && uncertainty > 0; ++k)
            differences[k] -= excess * (parts_[first + k].kept * parts_[first + k].variance / uncertainty);
        for (int c = 0; c < 3; ++c) {
            float lowest = 0;
            for (std::uint32_t k = 0; k < count; ++k) lowest = std::min(lowest, differences[k][c]);
            const float limit = -lowest > after[i][c] ? after[i][c] / -lowest : 1;
            for (std::uint32_t k = 0; k < count; ++k)
                after[first + k][c] = std::max(0.0f, after[i][c] + limit * differences[k][c]);
        }
    }
    return means;
}

/// Clusters preserve the mean over their area, but visible patches may be brighter than hidden ones. Visible patches
/// are scaled to the mean of the pictures before the reduction, hidden ones to keep the power.
void ClusterShrinkage::keep_means_of_pictures(std::vector<Rgb>& means) const {
    const ElementForest& forest = *state_->forest;
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    const std::vector<float>& seen = state_->solution.view_importance;
    if (seen.empty()) return;
    const std::vector<double> shares =
        clusters_->sums<double>([&](std::uint32_t p) { return seen[p] * forest.area(p); });
    const double fewest = fewest_camera_rays / static_cast<double>(state_->view.rays());
    std::vector<Region> regions(nodes.size());
    std::vector<std::uint32_t> region(nodes.size(), 0), region_of_patch(means.size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count] = nodes[i];
        if (shares[i] >= fewest) region[i] = i;
        if (first != none) {
            std::fill_n(region.begin() + first, count, region[i]);
            continue;
        }
        region_of_patch[count] = region[i];
        regions[region[i]].share += shares[i], regions[region[i]].area += forest.area(count);
    }
    for (std::uint32_t p = 0; p < means.size(); ++p)
        regions[region_of_patch[p]].add(seen[p], forest.area(p), RgbD(irradiance_[p]), RgbD(means[p]));
    for (std::uint32_t p = 0; p < means.size(); ++p) {
        const Region& r = regions[region_of_patch[p]];
        for (int c = 0; c < 3 && r.share >= fewest; ++c) means[p][c] *= r.factor(seen[p], c);
    }
}

}  // namespace interflect::detail
