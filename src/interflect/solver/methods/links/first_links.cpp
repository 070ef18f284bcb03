#include "interflect/solver/methods/links/first_links.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

constexpr std::size_t patches_per_task = 8;

bool emits(const RunInputs& inputs, PatchIndex patch) { return channel_sum(inputs.materials.exitance(patch)) > 0; }

/// Returns an upper bound of the exchange of surfaces inside two spheres [m^2].
double largest_exchange(const Sphere& a, const Sphere& b, double area_a, double area_b) {
    const double gap = std::max(0.0f, (a.centre - b.centre).length() - a.radius - b.radius);
    return area_a * area_b / (std::numbers::pi * gap * gap);
}

/// Collects pairs of patches that face each other, and chooses the effort for each pair.
class PatchPairs {
  public:
    PatchPairs(const RunInputs& inputs, const LightState& light, const ExchangeEstimator& estimator)
        : inputs_(inputs),
          forest_(*light.forest),
          epsilon_(light.options().experimental.epsilon),
          estimator_(estimator) {
        for (PatchIndex i{0}; i < forest_.patch_count(); ++i) {
            spheres_.push_back(sphere_around(forest_, i));
            total_area_ += forest_.area(i);
        }
    }

    void add(PatchIndex i, PatchIndex j, std::vector<LinkCandidate>& candidates) const {
        if (estimator_.face_each_other({i, j}))
            candidates.push_back({{i, j}, is_weak(i, j) ? Effort::quick : Effort::thorough});
    }

  private:
    /// Returns whether a reflector of average brightness sends less power than the threshold over this exchange.
    bool is_weak(PatchIndex i, PatchIndex j) const {
        return !emits(inputs_, i) && !emits(inputs_, j) &&
               largest_exchange(spheres_[i], spheres_[j], forest_.area(i), forest_.area(j)) < epsilon_ * total_area_;
    }

    const RunInputs& inputs_;
    const ElementForest& forest_;
    double epsilon_;
    const ExchangeEstimator& estimator_;
    std::vector<Sphere> spheres_;
    double total_area_ = 0;  // [m^2]
};

/// Divides pairs of clusters until the approximation of ClusterExchange is valid.
struct PairDivision {
    const ElementForest& forest;
    const PatchTree& tree;
    const ClusterExchange& exchange;
    const PatchPairs& patch_pairs;
    std::size_t limit;
    std::vector<LinkCandidate> candidates = {};

    void add(ElementIndex a, ElementIndex b) {
        if (candidates.size() > limit) return;
        if (!is_cluster(a) && !is_cluster(b)) return patch_pairs.add(forest.patch(a), forest.patch(b), candidates);
        if (exchange.is_valid({a, b})) return candidates.push_back({{a, b}, Effort::quick});
        const bool divides_a =
            is_cluster(a) && (!is_cluster(b) || tree.cluster(a).sphere.radius >= tree.cluster(b).sphere.radius);
        for (const ElementIndex child : tree.cluster(divides_a ? a : b).children) add(child, divides_a ? b : a);
    }

    void add_within(ElementIndex end) {
        if (!is_cluster(end)) return;
        const auto& [first, second] = tree.cluster(end).children;
        add_within(first);
        add_within(second);
        add(first, second);
    }
};

}  // namespace

std::vector<PatchIndex> patches_to_cluster(const RunInputs& inputs, const LightState& light) {
    std::vector<PatchIndex> patches;
    if (!light.options().experimental.clusters || light.forest->capacity() > first_cluster) return patches;
    for (PatchIndex p{0}; p < light.forest->patch_count(); ++p)
        if (!emits(inputs, p)) patches.push_back(p);
    return patches;
}

std::vector<LinkCandidate> pairs_of_patches(const SolverState& state, const ExchangeEstimator& estimator,
                                            std::size_t limit) {
    const PatchPairs pairs(state.inputs, state.light, estimator);
    const std::uint32_t patches = state.light.forest->patch_count();
    std::vector<std::vector<LinkCandidate>> of_patch(patches);
    std::atomic<std::size_t> count{0};
    parallel_for_ranges(of_patch.size(), patches_per_task, state.work.stop.within_process(),
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t i = begin; i < end && count <= limit; ++i) {
                                for (PatchIndex b(i + 1); b < patches; ++b) pairs.add(PatchIndex(i), b, of_patch[i]);
                                count += of_patch[i].size();
                            }
                        });
    std::vector<LinkCandidate> candidates;
    candidates.reserve(count);
    for (const std::vector<LinkCandidate>& some : of_patch)
        candidates.insert(candidates.end(), some.begin(), some.end());
    return candidates;
}

std::vector<LinkCandidate> pairs_of_clusters(const RunInputs& inputs, const LightState& light,
                                             const ExchangeEstimator& estimator, const PatchTree& tree,
                                             const ClusterExchange& exchange, std::size_t limit) {
    const PatchPairs patch_pairs(inputs, light, estimator);
    PairDivision division{*light.forest, tree, exchange, patch_pairs, limit};
    const std::uint32_t patches = light.forest->patch_count();
    for (PatchIndex a{0}; a < patches && division.candidates.size() <= limit; ++a)
        if (emits(inputs, a))
            for (PatchIndex b{0}; b < patches; ++b)
                if (b != a && (b > a || !emits(inputs, b))) division.add(a, b);
    division.add_within(ElementIndex(first_cluster));
    return std::move(division.candidates);
}

}  // namespace interflect::detail
