#include "interflect/solver/shrinkage/cluster_shrinkage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"

namespace interflect::detail {

namespace {

/// Number of contributions to a part, found or expected, at which its measured variance has weight 1/2. With fewer
/// contributions, the variance tends to the one that the part's area and the cluster's mean suggest. Otherwise a part
/// without contributions would seem to be exactly black.
constexpr double contributions_of_half_trust = 8;
/// Number of contributions at which a part keeps at least half of its own mean, for any difference from its cluster.
/// With ten times this number, it keeps 99%. Bright faces beside a lamp need this, because they differ from most parts
/// of their cluster.
constexpr double contributions_of_own_mean = 80;
/// Minimum number of camera rays in a region of the pictures that keeps its mean. Smaller regions would restore the
/// noise of the unshrunk light.
constexpr double fewest_camera_rays = 1024;
constexpr std::size_t clusters_per_task = 1 << 10;

struct Sums {
    double area = 0, power = 0;  // area [m^2] and luminance of the received power
    double variance = 0;         // variance of `power`

    explicit Sums(double a = 0, double p = 0, double v = 0) : area(a), power(p), variance(v) {}
    Sums& operator+=(const Sums& o) {
        area += o.area;
        power += o.power;
        variance += o.variance;
        return *this;
    }
    double mean() const { return power / area; }
    double payload() const { return variance / power; }
    double contributions() const { return variance > 0 ? power * power / variance : 0; }
};

/// Returns the variance of a part's mean. @param least_payload  Smallest payload of the cluster's parts.
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
/// smallest variance with which the deviations of the samples from their weighted mean are as large as expected.
double variance_of_true_values(std::span<const Sample> samples) {
    constexpr double tolerance = 1e-3;  // relative; the standard error of the estimate is at least a tenth
    constexpr int most_steps = 20;
    const double expected = static_cast<double>(samples.size() - 1);
    double signal = 0;
    for (int step = 0; step < most_steps; ++step) {  // Newton's method for 1 / sum, which is nearly linear
        double weights = 0, mean = 0, sum = 0, slope = 0;
        for (const auto& [value, variance] : samples) {
            weights += 1 / (signal + variance);
            mean += value / (signal + variance);
        }
        mean /= weights;
        for (const auto& [value, variance] : samples) {
            const double weight = 1 / (signal + variance), square = (value - mean) * (value - mean) * weight;
            sum += square;
            slope += square * weight;
        }
        if (signal == 0 && !(sum > expected)) break;
        const double change = (sum - expected) * sum / (expected * slope);
        signal = std::max(0.0, signal + change);
        if (std::abs(change) < tolerance * signal) break;
    }
    return signal;
}

/// Patches whose mean in the pictures is preserved together.
struct Region {
    double share = 0, area = 0;            // share of the pictures; area of the patches [m^2]
    RgbD before{0, 0, 0}, after{0, 0, 0};  // light in the pictures before and after shrinkage
    // Uncertain light in the pictures and on the surfaces, without and with the weight visibility():
    RgbD shown{0, 0, 0}, shown_visible{0, 0, 0}, power{0, 0, 0}, power_visible{0, 0, 0};

    /// Returns 1 for patches that are at least as visible as the region on average, and less for other patches.
    double visibility(double seen) const { return std::min(1.0, seen * area / share); }

    /// Adds a patch.
    /// @param seen         View importance of the patch [1/m^2].
    /// @param uncertainty  Share of the cluster's mean in the shrunk light.
    void add(double seen, double patch_area, double uncertainty, const RgbD& unreduced, const RgbD& reduced) {
        if (!(share > 0)) return;
        before += seen * patch_area * unreduced;
        after += seen * patch_area * reduced;
        const RgbD uncertain = uncertainty * patch_area * reduced;
        shown += seen * uncertain;
        power += uncertain;
        shown_visible += visibility(seen) * seen * uncertain;
        power_visible += visibility(seen) * uncertain;
    }

    /// Returns the factor 1 + x uncertainty (visibility - y) of a patch. The numbers x and y preserve the power and
    /// make `after` equal to `before`. If few patches are hidden, y = 0. No patch changes by more than its uncertain
    /// light.
    float factor(double seen, double uncertainty, int c) const {
        constexpr double most = 0.5;  // maximum relative change of hidden patches
        const auto change = [&](double y) { return (before[c] - after[c]) / (shown_visible[c] - y * shown[c]); };
        if (!(shown_visible[c] > 0)) return 1;
        double y = power_visible[c] / power[c];
        if (!(std::abs(y * change(y)) <= most)) y = 0;
        return static_cast<float>(1 + std::clamp(change(y), -1.0, 1.0) * uncertainty * (visibility(seen) - y));
    }
};

}  // namespace

ClusterShrinkage::ClusterShrinkage(const LightState& light, const PatchClusters& clusters,
                                   std::span<const Rgb> irradiance)
    : light_(&light), clusters_(&clusters), irradiance_(irradiance), parts_(clusters.nodes().size()) {
    measure_parts();
}

std::vector<Rgb> ClusterShrinkage::means(std::int64_t camera_rays) const {
    std::vector<Rgb> means = reduce();
    keep_means_of_pictures(camera_rays, means);
    return means;
}

void ClusterShrinkage::measure_parts() {
    const LightState& light = *light_;
    const ElementForest& forest = *light.forest;
    const std::vector<Sums> sums = clusters_->sums<Sums>([&](PatchIndex p) {
        const double area = forest.area(p), all = luminance(light.solution.irradiance[p]),
                     h = luminance(irradiance_[p]);
        const double of_all =
            light.noise.variance(forest, light.solution.irradiance, p, std::max(light.history[p], 1.0f));
        // A part of the light consists of a part of the rays, with the same payloads.
        const double variance = all > 0 ? of_all * std::clamp(h / all, 0.0, 1.0) : 0;
        return Sums(area, area * h, area * area * variance);
    });

    // Estimate the signal of each cluster, and the share of its own mean that each part keeps
    parts_[0].variance = static_cast<float>(sums[0].variance / (sums[0].area * sums[0].area));
    parallel_for_ranges(sums.size(), clusters_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Sample> samples;
        for (std::size_t i = begin; i < end; ++i) {
            const auto [first, count, patch] = clusters_->nodes()[i];
            if (patch != none) continue;
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
                part.variance = static_cast<float>(samples[k].variance);
                part.signal = static_cast<float>(signal);
                const double own = sums[first + k].contributions() / contributions_of_own_mean;
                const double by_signal = signal / (signal + samples[k].variance),
                             by_count = own * own / (1 + own * own);
                part.kept = static_cast<float>(std::max(by_signal, by_count));
            }
        }
    });
}

/// Returns the shrunk means of the parts of a cluster in one channel. Their area-weighted mean is `mean`. Uncertain
/// parts change most. No part changes by more than `most_errors` standard errors (limited translation: Efron and
/// Morris, Limiting the risk of Bayes and empirical Bayes estimators, 1972).
/// @param own         Unshrunk means of the parts.
/// @param mean        Shrunk mean of the cluster.
/// @param to_channel  Ratio of the irradiance of the channel to the luminance.
ClusterShrinkage::Means ClusterShrinkage::reduce_parts(std::span<const Part> parts, const Means& own, float mean,
                                                       float to_channel) {
    constexpr float most_errors = 3, tolerance = 1e-6f;
    constexpr int most_steps = 10;
    Means reduced;
    float missing = 0;                               // difference between `mean` and the mean of the parts
    float shared = 0;                                // each part changes by this multiple of kept * variance
    for (int step = 0; step < most_steps; ++step) {  // Newton's method for a sum that is linear in pieces
        float slope = 0;
        missing = mean;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const auto [share, kept, variance, signal] = parts[k];
            const float most = most_errors * std::sqrt(variance) * to_channel, weight = kept * variance,
                        wanted = (1 - kept) * (mean - own[k]) + shared * weight,
                        change = std::clamp(wanted, -std::min(most, own[k]), most);
            reduced[k] = own[k] + change;
            missing -= share * reduced[k];
            if (change == wanted) slope += share * weight;
        }
        if (!(std::abs(missing) > tolerance * mean) || !(slope > 0)) break;
        shared += missing / slope;
    }
    float variance = 0;
    for (const Part& part : parts) variance += part.share * part.variance;
    for (std::size_t k = 0; k < parts.size() && variance > 0; ++k)
        reduced[k] = std::max(0.0f, reduced[k] + missing * parts[k].variance / variance);
    return reduced;
}

/// Returns the shrunk means of the patches. Shrinks clusters from the root of the tree down to the patches.
std::vector<Rgb> ClusterShrinkage::reduce() const {
    std::vector<Rgb> means(irradiance_.begin(), irradiance_.begin() + clusters_->patch_count());
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();

    // Compute the unshrunk means from the patches up
    std::vector<Rgb> before(nodes.size(), Rgb(0));
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const auto [first, count, patch] = nodes[i];
        if (patch != none)
            before[i] = irradiance_[patch];
        else
            for (std::uint32_t k = first; k < first + count; ++k) before[i] += parts_[k].share * before[k];
    }

    // Shrink the parts of each cluster from the root down
    std::vector<Rgb> after(nodes.size());
    after[0] = before[0];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count, patch] = nodes[i];
        if (patch != none) {
            means[patch] = after[i];
            continue;
        }
        const float light = luminance(after[i]);
        for (int c = 0; c < 3; ++c) {
            Means own;
            for (std::uint32_t k = 0; k < count; ++k) own[k] = before[first + k][c];
            const float to_channel = light > 0 ? after[i][c] / light : 0;
            own = reduce_parts({&parts_[first], count}, own, after[i][c], to_channel);
            for (std::uint32_t k = 0; k < count; ++k) after[first + k][c] = own[k];
        }
    }
    return means;
}

/// Restores the means of regions of the pictures. Shrinkage preserves the mean over the area of a cluster, but its
/// visible patches may be brighter than its hidden patches. Scales the uncertain light of visible patches to restore
/// the mean of the pictures, and the light of hidden patches to preserve the power.
void ClusterShrinkage::keep_means_of_pictures(std::int64_t camera_rays, std::vector<Rgb>& means) const {
    const ElementForest& forest = *light_->forest;
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    const std::vector<float>& seen = light_->solution.view_importance;
    if (seen.empty()) return;
    const std::vector<double> shares = clusters_->sums<double>([&](PatchIndex p) { return seen[p] * forest.area(p); });
    const double fewest = fewest_camera_rays / static_cast<double>(camera_rays);

    // Assign each patch to the smallest cluster that enough camera rays hit
    std::vector<Region> regions(1);  // the first consists of patches that no such cluster contains
    std::vector<std::uint32_t> region(nodes.size(), 0), region_of_patch(means.size());
    std::vector<float> uncertainty(means.size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count, patch] = nodes[i];
        if (i > 0 && shares[i] >= fewest) {
            region[i] = static_cast<std::uint32_t>(regions.size());
            regions.emplace_back();
        }
        if (patch == none) {
            std::fill_n(region.begin() + first, count, region[i]);
            continue;
        }
        region_of_patch[patch] = region[i];
        uncertainty[patch] = 1 - parts_[i].kept;
        regions[region[i]].share += shares[i], regions[region[i]].area += forest.area(patch);
    }

    // Sum the light of the regions before and after shrinkage, then scale the patches
    for (PatchIndex p{0}; p < means.size(); ++p)
        regions[region_of_patch[p]].add(seen[p], forest.area(p), uncertainty[p], RgbD(irradiance_[p]), RgbD(means[p]));
    for (PatchIndex p{0}; p < means.size(); ++p) {
        const Region& r = regions[region_of_patch[p]];
        for (int c = 0; c < 3 && r.share >= fewest; ++c) means[p][c] *= r.factor(seen[p], uncertainty[p], c);
    }
}

}  // namespace interflect::detail
