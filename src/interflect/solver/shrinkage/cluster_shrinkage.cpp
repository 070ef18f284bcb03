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
constexpr std::size_t clusters_per_task = 1 << 10;

struct Sums {
    double weight = 0, power = 0;  // luminance of the irradiance times the weight
    double variance = 0;           // of the power

    explicit Sums(double w = 0, double p = 0, double v = 0) : weight(w), power(p), variance(v) {}
    Sums& operator+=(const Sums& o) {
        weight += o.weight, power += o.power, variance += o.variance;
        return *this;
    }
    double mean() const { return power / weight; }
    double payload() const { return variance / power; }
    double contributions() const { return variance > 0 ? power * power / variance : 0; }
};

/// Returns the variance of a part's mean. @param least_payload  Of the cluster's parts.
double variance_of(const Sums& part, double cluster_mean, double least_payload) {
    const bool is_known = part.power > 0 && part.variance > 0;
    const double payload = is_known ? part.payload() : least_payload;
    const double expected = cluster_mean * part.weight / payload,
                 contributions = std::max(part.contributions(), expected),
                 measured = contributions / (contributions + contributions_of_half_trust);
    return (measured * part.variance / part.weight + (1 - measured) * payload * cluster_mean) / part.weight;
}

struct Sample {
    double value, variance;
};

/// Estimates the variance of the true values (Paule and Mandel, Consensus values and weighting factors, 1982): the
/// least with which the samples' deviations from their weighted mean are as large as expected. Precise samples decide.
double variance_of_true_values(std::span<const Sample> samples) {
    constexpr double tolerance = 1e-3;  // relative; the estimate varies by a tenth or more
    constexpr int most_steps = 20;
    const double expected = static_cast<double>(samples.size() - 1);
    double signal = 0;
    for (int step = 0; step < most_steps; ++step) {  // Newton's method for 1 / sum, which is nearly linear
        double weights = 0, mean = 0, sum = 0, slope = 0;
        for (const auto& [value, variance] : samples)
            weights += 1 / (signal + variance), mean += value / (signal + variance);
        mean /= weights;
        for (const auto& [value, variance] : samples) {
            const double weight = 1 / (signal + variance), square = (value - mean) * (value - mean) * weight;
            sum += square, slope += square * weight;
        }
        if (signal == 0 && !(sum > expected)) break;
        const double change = (sum - expected) * sum / (expected * slope);
        signal = std::max(0.0, signal + change);
        if (std::abs(change) < tolerance * signal) break;
    }
    return signal;
}

}  // namespace

ClusterShrinkage::ClusterShrinkage(const SolverState& state, const PatchClusters& clusters,
                                   std::span<const Rgb> irradiance)
    : state_(&state),
      clusters_(&clusters),
      irradiance_(irradiance),
      weights_(clusters.patch_count()),
      parts_(clusters.nodes().size()) {
    const std::vector<float>& seen = state.solution.view_importance;
    for (std::uint32_t p = 0; p < weights_.size(); ++p)
        weights_[p] = state.forest->area(p) * (clusters.is_shown(p) ? static_cast<double>(seen[p]) : 1.0);
    measure_parts();
}

std::vector<Rgb> ClusterShrinkage::means() const {
    std::vector<Rgb> means = reduce();
    keep_reflected_light(means);
    return means;
}

void ClusterShrinkage::measure_parts() {
    const SolverState& state = *state_;
    const ElementForest& forest = *state.forest;
    const std::vector<Sums> sums = clusters_->sums<Sums>([&](std::uint32_t p) {
        const double weight = weights_[p], all = luminance(state.solution.irradiance[p]), h = luminance(irradiance_[p]);
        const double of_all =
            state.noise.variance(forest, state.solution.irradiance, p, std::max(state.history[p], 1.0f));
        const double variance = all > 0 ? of_all * std::clamp(h / all, 0.0, 1.0) : 0;  // fewer of the same rays
        return Sums(weight, weight * h, weight * weight * variance);
    });
    for (std::uint32_t root = 0; root < clusters_->root_count(); ++root)
        parts_[root].variance = static_cast<float>(sums[root].variance / (sums[root].weight * sums[root].weight));
    parallel_for_ranges(sums.size(), clusters_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Sample> samples;
        for (std::size_t i = begin; i < end; ++i) {
            const auto [first, count] = clusters_->nodes()[i];
            if (first == none) continue;
            for (std::uint32_t k = first; k < first + count; ++k)
                parts_[k].share = static_cast<float>(sums[k].weight / sums[i].weight);
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

/// From the roots to the patches.
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
    std::copy_n(before.begin(), clusters_->root_count(), after.begin());
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

/// Clusters keep the weighted mean of the irradiance. The patches of each tree also keep the light that they reflect:
/// uncertain ones are scaled by 1 + x (1 - kept) (rho - y), where x and y keep both.
void ClusterShrinkage::keep_reflected_light(std::vector<Rgb>& means) const {
    constexpr double most = 1;  // no patch becomes negative
    struct Sums {
        RgbD lost{0, 0, 0}, uncertain{0, 0, 0}, reflected{0, 0, 0}, square{0, 0, 0};  // by power of rho: 1, 0, 1, 2
    };
    std::array<Sums, 2> trees;  // patches that the views show, and others
    std::vector<float> uncertainty(means.size(), 0.0f);
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].is_patch()) continue;
        const std::uint32_t p = nodes[i].count;
        uncertainty[p] = 1 - parts_[i].kept;
        const RgbD rho(state_->materials.surface(p, p).reflectance),
            light = weights_[p] * RgbD(means[p]), uncertain = static_cast<double>(uncertainty[p]) * light;
        Sums& tree = trees[clusters_->is_shown(p) ? 1 : 0];
        tree.lost += rho * (weights_[p] * RgbD(irradiance_[p]) - light);
        tree.uncertain += uncertain, tree.reflected += rho * uncertain, tree.square += rho * rho * uncertain;
    }
    for (std::uint32_t p = 0; p < means.size(); ++p) {
        const Sums& tree = trees[clusters_->is_shown(p) ? 1 : 0];
        const Rgb rho = state_->materials.surface(p, p).reflectance;
        for (int c = 0; c < 3 && uncertainty[p] > 0; ++c) {
            if (!(tree.uncertain[c] > 0)) continue;
            const double y = tree.reflected[c] / tree.uncertain[c], spread = tree.square[c] - y * tree.reflected[c],
                         x = std::clamp(tree.lost[c] / spread, -most, most);
            if (spread > 0) means[p][c] *= static_cast<float>(1 + x * uncertainty[p] * (rho[c] - y));
        }
    }
}

}  // namespace interflect::detail
