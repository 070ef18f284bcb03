#include "interflect/solver/shrinkage/cluster_shrinkage.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "interflect/core.h"

namespace interflect::detail {

namespace {

/// Contributions of a part, found or expected, at which its measured variance has weight 1/2. With fewer, parts tend to
/// the variance that their area and the mean of the cluster suggest: one without any would seem to be exactly black.
constexpr double contributions_of_half_weight = 16;

/// In a region of the pictures that keeps its mean. Fewer would bring noise of the unreduced light back.
constexpr double fewest_camera_rays = 1024;

struct Sums {
    double area = 0, power = 0;  // [m^2], luminance of the received power
    double variance = 0;         // of the power

    explicit Sums(double a = 0, double p = 0, double v = 0) : area(a), power(p), variance(v) {}
    Sums& operator+=(const Sums& o) {
        area += o.area, power += o.power, variance += o.variance;
        return *this;
    }
    double mean() const { return power / area; }
    double contributions() const { return variance > 0 ? power * power / variance : 0; }
};

/// Returns the mean square errors that the differences of n parts add (Stein 1981, in n - 1 dimensions).
/// @param kept  Factor of the differences.
AddedError error_of_parts(std::size_t parts, double spread, double noise, double kept, double mean) {
    const auto dimensions = static_cast<double>(parts - 1);
    const double risk = kept > 0 ? noise + noise * noise / spread * (4 - dimensions) / dimensions : spread - noise;
    const double most = dimensions * mean * mean;  // largest variance of non-negative numbers
    return {static_cast<float>(kept * kept * noise),
            static_cast<float>(std::clamp(risk - kept * kept * noise, -most, most))};
}

/// Sets the factors of a cluster's parts. @return  The error that their differences add.
AddedError shrink(const Sums& cluster, std::span<const Sums> sums, std::span<ClusterPart> parts) {
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].share = static_cast<float>(sums[k].area / cluster.area);
    if (!(cluster.variance > 0)) return {};
    const double payload = cluster.variance / cluster.power, mean = cluster.mean();
    double spread = 0, noise = 0, mean_variance = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Sums& part = sums[k];
        const double difference = part.mean() - mean, share = parts[k].share;
        const double expected = mean * part.area / payload, contributions = std::max(part.contributions(), expected),
                     measured = contributions / (contributions + contributions_of_half_weight);
        const double variance = (measured * part.variance / part.area + (1 - measured) * payload * mean) / part.area;
        parts[k].noise = static_cast<float>(variance);
        spread += share * difference * difference;
        noise += share * (1 - share) * variance;
        mean_variance += share * variance;
    }
    const float kept = spread > noise ? static_cast<float>(1 - noise / spread) : 0;
    float remaining = 0;
    for (ClusterPart& part : parts) {
        const float relative = part.noise / static_cast<float>(mean_variance);
        part.kept = kept > 0 ? kept / (kept + (1 - kept) * relative) : 0;
        part.noise = kept > 0 ? relative * part.kept : 1;
        remaining += part.share * part.noise;
    }
    for (ClusterPart& part : parts) part.noise = remaining > 0 ? part.noise / remaining : 1;
    return error_of_parts(parts.size(), spread, noise, static_cast<double>(kept), mean);
}

}  // namespace

ClusterShrinkage::ClusterShrinkage(const SolverState& state, const PatchClusters& clusters)
    : clusters_(&clusters),
      parts_(clusters.nodes().size()),
      added_(clusters.nodes().size()),
      limit_(clusters.nodes().size()),
      restored_(clusters.patch_count(), Rgb(1)) {
    const ElementForest& forest = *state.forest;
    const std::vector<Rgb>& irradiance = state.solution.irradiance;
    const std::vector<Sums> sums = clusters.sums<Sums>([&](std::uint32_t p) {
        const double area = forest.area(p);
        const float variance = state.noise.variance(forest, irradiance, p, std::max(state.history[p], 1.0f));
        return Sums(area, area * luminance(irradiance[p]), area * area * variance);
    });
    noise_of_scene_ = static_cast<float>(sums[0].variance / (sums[0].area * sums[0].area));
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const PatchClusters::Node& cluster = clusters.nodes()[i];
        if (cluster.is_patch()) continue;
        const std::span<const Sums> of_parts = std::span(sums).subspan(cluster.first_child, cluster.count);
        added_[i] = shrink(sums[i], of_parts, std::span(parts_).subspan(cluster.first_child, cluster.count));
    }
    const std::vector<Rgb> all =
        reduced(irradiance, [&](std::size_t i, const Rgb& mean, std::span<const Rgb> differences) {
            limit_[i] = Rgb(1);
            for (int c = 0; c < 3; ++c) {
                float lowest = 0;
                for (const Rgb& difference : differences) lowest = std::min(lowest, difference[c]);
                if (-lowest > mean[c]) limit_[i][c] = mean[c] / -lowest;
            }
            return limit_[i];
        });
    keep_means_of_pictures(state, all);
}

void ClusterShrinkage::keep_means_of_pictures(const SolverState& state, std::span<const Rgb> reduced) {
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    const std::vector<float>& seen = state.solution.view_importance;
    if (seen.empty()) return;
    const std::vector<double> shares =
        clusters_->sums<double>([&](std::uint32_t p) { return seen[p] * state.forest->area(p); });
    const double fewest = fewest_camera_rays / static_cast<double>(state.view.rays());
    struct Region {
        double share = 0;
        RgbD before{0, 0, 0}, after{0, 0, 0};
    };
    std::vector<Region> regions(nodes.size());
    std::vector<std::uint32_t> region(nodes.size(), 0), region_of_patch(clusters_->patch_count());
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count] = nodes[i];
        if (shares[i] >= fewest) region[i] = i;
        if (!nodes[i].is_patch()) {
            std::fill_n(region.begin() + first, count, region[i]);
            continue;
        }
        Region& of_patch = regions[region_of_patch[count] = region[i]];
        of_patch.share += shares[i];
        of_patch.before += shares[i] * RgbD(state.solution.irradiance[count]);
        of_patch.after += shares[i] * RgbD(reduced[count]);
    }
    for (std::uint32_t p = 0; p < restored_.size(); ++p) {
        const auto& [share, before, after] = regions[region_of_patch[p]];
        for (int c = 0; c < 3; ++c)
            if (share >= fewest && after[c] > 0) restored_[p][c] = static_cast<float>(before[c] / after[c]);
    }
}

template <class LimitOf>
std::vector<Rgb> ClusterShrinkage::reduced(std::span<const Rgb> irradiance, const LimitOf& limit_of) const {
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    const std::vector<RgbD> before = means(irradiance);
    std::vector<Rgb> after(nodes.size()), of_patch(clusters_->patch_count());
    after[0] = Rgb(before[0]);
    std::array<Rgb, PatchClusters::most_parts> differences;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto [first, count] = nodes[i];
        if (nodes[i].is_patch()) {
            of_patch[count] = restored_[count] * after[i];
            continue;
        }
        Rgb sum(0);
        for (std::uint32_t k = 0; k < count; ++k) {
            differences[k] = parts_[first + k].kept * Rgb(before[first + k] - before[i]);
            sum += parts_[first + k].share * differences[k];
        }
        for (std::uint32_t k = 0; k < count; ++k) differences[k] -= parts_[first + k].noise * sum;
        const Rgb limit = limit_of(i, after[i], std::span(differences).first(count));
        for (std::uint32_t k = 0; k < count; ++k) after[first + k] = after[i] + limit * differences[k];
    }
    return of_patch;
}

std::vector<RgbD> ClusterShrinkage::means(std::span<const Rgb> irradiance) const {
    const std::span<const PatchClusters::Node> nodes = clusters_->nodes();
    std::vector<RgbD> means(nodes.size(), RgbD(0));
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const auto [first, count] = nodes[i];
        if (nodes[i].is_patch())
            means[i] = RgbD(irradiance[count]);
        else
            for (std::uint32_t k = 0; k < count; ++k)
                means[i] += static_cast<double>(parts_[first + k].share) * means[first + k];
    }
    return means;
}

std::vector<Rgb> ClusterShrinkage::reduce(std::span<const Rgb> irradiance) const {
    return reduced(irradiance, [&](std::size_t i, const Rgb&, std::span<const Rgb>) { return limit_[i]; });
}

}  // namespace interflect::detail
