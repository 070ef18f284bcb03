#include "interflect/solver/methods/links/link_radiosity.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <string>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/refinement/oracle_threshold.h"

namespace interflect::detail {

struct RefinementCandidate {
    std::size_t link;
    ElementIndex divided;
    double factor;  // error bound over the threshold
};

namespace {

/// Links are refined if the relative change of light in a sweep is below `settled`. If no link can be refined, the run
/// ends when the change is below `negligible_change`.
constexpr double settled = 1e-2, negligible_change = 1e-6;
/// Relative error bound of a link whose 16 sampled lines of sight are all blocked, because one more line may be free.
constexpr double bound_if_blocked = 1.0 / 16;
/// Maximum number of rays for the four links that replace one: 16 lines of sight in both directions.
constexpr std::int64_t rays_per_division = std::int64_t{4} * 2 * 16;
constexpr std::size_t pairs_per_task = 256;
/// Number of rays of a quick link: 4 lines of sight in both directions.
constexpr double rays_of_quick_link = 2 * 4;
/// All patches are linked directly if their links need at most this share of the rays. At 20 million rays, this allows
/// 707 patches. Links between 1,902 patches need 0.7 of the rays, and have 1.6 times the error of clusters
/// (docs/method/results.md).
constexpr double share_of_pairs = 0.1;
/// Number of partial sums of light from clusters. It is fixed, so that the number of threads does not change the order
/// of additions.
constexpr std::size_t cluster_sums = 8;

template <class T>
void gather_from_clusters(const ElementForest& forest, const ClusterExchange& clusters, std::span<const Link> links,
                          const std::vector<T>& leaving, T (Link::*area_of)() const, std::vector<T>& received) {
    if (std::none_of(links.begin(), links.end(), [](const Link& link) { return has_cluster(link.ends); })) return;
    std::vector<std::vector<T>> sums(cluster_sums, std::vector<T>(forest.size(), T(0)));
    parallel_for_ranges(cluster_sums, 1, [&](std::size_t part, std::size_t) {
        const std::size_t begin = part * links.size() / cluster_sums, end = (part + 1) * links.size() / cluster_sums;
        for (const Link& link : links.subspan(begin, end - begin))
            if (has_cluster(link.ends))
                clusters.transport(link.ends, (link.*area_of)() / static_cast<double>(link.exchange.area), leaving,
                                   sums[part]);
    });
    parallel_for_ranges(forest.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (const std::vector<T>& sum : sums)
            for (std::size_t e = begin; e < end; ++e) received[e] += sum[e];
    });
}

/// Gathers one bounce over all links. @param area_of  Link::area or Link::mean_area.
template <class T>
std::vector<T> gather(const ElementForest& forest, const ClusterExchange& clusters, std::span<const Link> links,
                      const std::vector<T>& leaving, T (Link::*area_of)() const) {
    std::vector<T> received(forest.size(), T(0));
    for (const Link& link : links) {
        const auto [a, b] = link.ends;
        if (has_cluster(link.ends)) continue;
        const T area = (link.*area_of)();
        received[a] += leaving[b] * area;
        received[b] += leaving[a] * area;
    }
    gather_from_clusters(forest, clusters, links, leaving, area_of, received);
    for (ElementIndex e{0}; e < forest.size(); ++e) received[e] /= forest.area(e);
    push(forest, received);
    pull(forest, received);
    return received;
}

/// Returns the radiosity of every element. Counts non-finite values and sets them to 0.
std::vector<Rgb> present_radiosity(const RunInputs& inputs, LightState& light) {
    const Radiosity radiosity(inputs.materials, light.solution.irradiance);
    std::vector<Rgb> b;
    b.reserve(light.forest->size());
    for (ElementIndex e{0}; e < light.forest->size(); ++e) {
        b.push_back(radiosity.of(*light.forest, e));
        light.solution.non_finite += radiosity.is_not_finite(*light.forest, e);
    }
    if (inputs.materials.has_textures()) pull(*light.forest, b);
    return b;
}

/// Sum of area x |new - old|, relative to the sum of area x new.
class RelativeChange {
  public:
    void add(double area, double before, double now) {
        change_ += area * std::abs(now - before);
        sum_ += area * now;
    }
    double value() const { return sum_ > 0 ? change_ / sum_ : 0; }

  private:
    double change_ = 0, sum_ = 0;
};

}  // namespace

LinkedElements::LinkedElements(SolverState& state, std::size_t link_limit)
    : state_(state),
      forest_(*state.light.forest),
      estimator_(state.inputs.scene, *state.light.forest, state.inputs.ray_caster, state.light.options().seed),
      tree_(*state.light.forest, patches_to_cluster(state.inputs, state.light)),
      clusters_(*state.light.forest, tree_, estimator_, state.light.options().seed),
      link_limit_(link_limit),
      refines_(state.light.options().method.refines) {}

void LinkedElements::require_room_for(std::size_t more) const {
    if (links_.size() + more <= link_limit_) return;
    throw InputError("'" + state_.inputs.scene.name + "' needs more than " + std::to_string(link_limit_) +
                     " links between its " + std::to_string(forest_.patch_count()) + " patches and their elements, " +
                     std::to_string(sizeof(Link)) +
                     " bytes each: raise epsilon or min_area, lower rays, or use a method without links, such as "
                     "hsrr");
}

void LinkedElements::prepare(SolverState&) {
    if (candidates_.empty()) find_first_links();
    link_candidates();
}

/// Chooses all pairs of patches as candidates if most of the rays then remain for refinement, else pairs of clusters.
void LinkedElements::find_first_links() {
    const double pairs = 0.5 * forest_.patch_count() * (forest_.patch_count() - 1.0);
    const auto rays = static_cast<double>(std::min(state_.light.options().limits.rays, SolveOptions().limits.rays));
    const bool links_patches = tree_.clusters().empty() || pairs * rays_of_quick_link <= share_of_pairs * rays;
    candidates_ = links_patches
                      ? pairs_of_patches(state_, estimator_, link_limit_)
                      : pairs_of_clusters(state_.inputs, state_.light, estimator_, tree_, clusters_, link_limit_);
}

Exchange LinkedElements::estimate(const LinkCandidate& candidate, std::int64_t& rays) const {
    const auto& [ends, effort] = candidate;
    return has_cluster(ends) ? clusters_.estimate(ends, effort, rays) : estimator_.estimate(ends, effort, rays);
}

/// Makes links of the candidates. Omits pairs without unoccluded exchange.
void LinkedElements::link_candidates() {
    require_room_for(candidates_.size());
    std::vector<Link> made(candidates_.size());
    std::atomic<std::int64_t> rays{0};
    parallel_for_ranges(made.size(), pairs_per_task, state_.work.stop.within_process(),
                        [&](std::size_t begin, std::size_t end) {
                            std::int64_t used = 0;
                            for (std::size_t i = begin; i < end; ++i)
                                made[i] = {candidates_[i].ends, estimate(candidates_[i], used)};
                            rays += used;
                        });
    rays_ += rays;
    links_.insert(links_.end(), made.begin(), made.end());
    std::erase_if(links_, [](const Link& l) { return l.exchange.area == 0; });
    candidates_.clear();
}

RgbD LinkedElements::gather_light() {
    const std::vector<Rgb> b = present_radiosity(state_.inputs, state_.light);
    const std::vector<RgbD> received =
        gather(forest_, clusters_, links_, std::vector<RgbD>(b.begin(), b.end()), &Link::area);
    RelativeChange change;
    RgbD escaped = integral(forest_, b);
    for (ElementIndex e{0}; e < forest_.size(); ++e) {
        Rgb& irradiance = state_.light.solution.irradiance[e];
        change.add(forest_.area(e), channel_sum(RgbD(irradiance)), channel_sum(received[e]));
        irradiance = Rgb(received[e]);
        const RgbD power = received[e] * static_cast<double>(forest_.area(e));
        if (e < forest_.patch_count()) escaped -= power;
        // Transmitted light counts twice above, because the pane and the surface behind it receive it.
        if (forest_.is_leaf(e))
            escaped += RgbD(state_.inputs.materials.surface(forest_.patch(e), e).transmittance) * power;
    }
    light_change_ = change.value();
    return escaped;
}

void LinkedElements::gather_importance() {
    const std::vector<float> psi = total_importance(state_.light.solution);
    std::vector<double> reflected(psi.size());
    for (ElementIndex e{0}; e < forest_.size(); ++e)
        reflected[e] = static_cast<double>(state_.inputs.materials.mean_reflectance(forest_.patch(e), e)) * psi[e];
    if (state_.inputs.materials.has_textures()) pull(forest_, reflected);
    const std::vector<double> received = gather(forest_, clusters_, links_, reflected, &Link::mean_area);
    RelativeChange change;
    for (ElementIndex e{0}; e < forest_.size(); ++e) {
        float& importance = state_.light.solution.indirect_importance[e];
        change.add(forest_.area(e), importance, received[e]);
        importance = static_cast<float>(received[e]);
    }
    importance_change_ = change.value();
}

namespace {

/// One value for each element and cluster.
template <class T>
struct EndValues {
    std::vector<T> of_element, of_cluster;

    const T& operator[](ElementIndex end) const {
        return is_cluster(end) ? of_cluster[end - first_cluster] : of_element[end];
    }
};

template <class T>
EndValues<T> mean_values(const ElementForest& forest, const PatchTree& tree, std::vector<T> of_element) {
    const auto area = [&](ElementIndex end) { return is_cluster(end) ? tree.cluster(end).area : forest.area(end); };
    std::vector<T> of_cluster = tree.pulled(of_element, [&](const PatchTree::Cluster& cluster, const T& x, const T& y) {
        const float area_x = area(cluster.children[0]), area_y = area(cluster.children[1]);
        return T((x * area_x + y * area_y) / (area_x + area_y));
    });
    return {std::move(of_element), std::move(of_cluster)};
}

struct RadiosityRange {
    EndValues<Rgb> least, most;

    RadiosityRange(const ElementForest& forest, const PatchTree& tree, const std::vector<Rgb>& b)
        : least{b, {}}, most{b, {}} {
        for (std::uint32_t i = forest.size(); i-- > forest.patch_count();) {
            const ElementIndex e(i);
            Rgb &low = least.of_element[forest.parent(e)], &high = most.of_element[forest.parent(e)];
            low = smaller(low, least[e]);
            high = larger(high, most[e]);
        }
        least.of_cluster =
            tree.pulled(least.of_element, [](const auto&, const Rgb& x, const Rgb& y) { return smaller(x, y); });
        most.of_cluster =
            tree.pulled(most.of_element, [](const auto&, const Rgb& x, const Rgb& y) { return larger(x, y); });
    }
};

bool is_valid(const Exchange& exchange) {
    const Rgb& t = exchange.transmittance;
    const std::array<float, 7> numbers{exchange.area, exchange.spread_over_a, exchange.spread_over_b, t.x, t.y,
                                       t.z,           exchange.variation};
    return std::all_of(numbers.begin(), numbers.end(), [](float n) { return n >= 0 && std::isfinite(n); });
}

/// Returns the error bound of an exchange [m^2], including partial occlusion.
double error_bound(const Exchange& exchange, float spread) {
    const float transmittance = largest_channel(exchange.transmittance);
    if (transmittance == 0 && exchange.variation == 0) return exchange.area * bound_if_blocked;
    return exchange.variation * exchange.area + (1 - exchange.variation) * transmittance * spread;
}

}  // namespace

/// Returns the links whose error bound exceeds the threshold. Each end has an error bound as receiver, from the
/// radiosity of the other end, and as source, from the range of its own radiosity.
std::vector<RefinementCandidate> LinkedElements::refinement_candidates() const {
    const Solution& solution = state_.light.solution;
    const EndValues<Rgb> b =
        mean_values(forest_, tree_, radiosity(state_.inputs.materials, forest_, solution.irradiance));
    const RadiosityRange range(forest_, tree_, b.of_element);
    const ImportanceUse use = importance_use(solution);
    const EndValues<float> psi =
        mean_values(forest_, tree_,
                    use == ImportanceUse::off ? std::vector<float>(forest_.size(), 1.0f) : total_importance(solution));
    std::vector<Rgb> of_element;
    for (ElementIndex e{0}; e < forest_.size(); ++e)
        of_element.push_back(state_.inputs.materials.surface(forest_.patch(e), e).reflectance);
    const EndValues<Rgb> rho = mean_values(forest_, tree_, std::move(of_element));
    const double threshold = solution.options.experimental.epsilon * reference_power(solution) *
                             (use == ImportanceUse::off ? 1 : reference_importance(solution, psi.of_element));
    std::vector<RefinementCandidate> candidates;
    if (!(threshold > 0)) return candidates;
    const auto weight = [&](ElementIndex divided, ElementIndex other) {
        const double as_receiver = largest_channel(rho[divided] * b[other]) * psi[divided];
        const double as_source =
            largest_channel(rho[other] * (range.most[divided] - range.least[divided])) * psi[other];
        return may_divide(divided) ? std::max(as_receiver, as_source) : 0.0;
    };
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const auto& [ends, exchange] = links_[i];
        const double over_a = weight(ends.a, ends.b) * error_bound(exchange, exchange.spread_over_a);
        const double over_b = weight(ends.b, ends.a) * error_bound(exchange, exchange.spread_over_b);
        if (std::max(over_a, over_b) > threshold)
            candidates.push_back({i, divided_end(ends, over_a, over_b), std::max(over_a, over_b) / threshold});
    }
    return candidates;
}

/// Returns the end with the larger error bound. If an end is a cluster and both bounds are positive, returns the larger
/// end.
ElementIndex LinkedElements::divided_end(const ElementPair& ends, double over_a, double over_b) const {
    if (has_cluster(ends) && over_a > 0 && over_b > 0)
        return clusters_.sphere(ends.a).radius >= clusters_.sphere(ends.b).radius ? ends.a : ends.b;
    return over_a > over_b ? ends.a : ends.b;
}

bool LinkedElements::may_divide(ElementIndex end) const {
    return is_cluster(end) ||
           forest_.area(end) >= 4.0 * static_cast<double>(state_.inputs.element_floor.default_min_area());
}

/// Keeps the candidates with the largest errors, so that the remaining rays suffice for their links.
void LinkedElements::keep_affordable(std::vector<RefinementCandidate>& candidates) const {
    const std::int64_t rays = std::max<std::int64_t>(0, state_.light.options().limits.rays - rays_);
    const auto affordable = static_cast<std::size_t>(rays / rays_per_division);
    if (candidates.size() <= affordable) return;
    const auto comes_first = [](const RefinementCandidate& x, const RefinementCandidate& y) {
        return x.factor != y.factor ? x.factor > y.factor : x.link < y.link;
    };
    std::sort(candidates.begin(), candidates.end(), comes_first);
    candidates.resize(affordable);
}

void LinkedElements::initialise_new_elements(std::uint32_t first) {
    Solution& solution = state_.light.solution;
    inherit(forest_, first, solution.irradiance);
    state_.inputs.materials.grow(forest_);
    if (state_.sampling.view.empty()) return;
    inherit(forest_, first, solution.indirect_importance);
    set_view_importance(state_.light, state_.sampling);
}

bool LinkedElements::refine_links() {
    if (candidates_.empty()) subdivide_links();
    const bool is_refined = !candidates_.empty();
    link_candidates();
    return is_refined;
}

void LinkedElements::subdivide_links() {
    std::vector<RefinementCandidate> refined = refinement_candidates();
    keep_affordable(refined);
    const std::uint32_t before = forest_.size();
    for (const RefinementCandidate& candidate : refined) {
        Link& link = links_[candidate.link];
        const ElementIndex divided = candidate.divided;
        const ElementIndex other = link.ends.a == divided ? link.ends.b : link.ends.a;
        const bool is_occluded = link.exchange.transmittance == Rgb(0) || link.exchange.variation > 0;
        const Effort effort = is_occluded ? Effort::thorough : Effort::quick;
        if (is_cluster(divided)) {
            for (const ElementIndex child : tree_.cluster(divided).children)
                candidates_.push_back({{child, other}, effort});
        } else {
            const ElementIndex child =
                forest_.is_leaf(divided) ? forest_.subdivide(divided) : forest_.first_child(divided);
            if (child == none) continue;
            for (std::uint32_t k = 0; k < 4; ++k) candidates_.push_back({{child + k, other}, effort});
        }
        link.exchange.area = 0;  // link_candidates() removes it
    }
    initialise_new_elements(before);
}

bool LinkedElements::is_fulfilled(const SolverState& state) const {
    return is_settled_ || (state.light.options().experimental.iterations > 0 &&
                           sweeps_ >= state.light.options().experimental.iterations);
}

IterationPlan LinkedElements::plan(SolverState& state) {
    return is_fulfilled(state) ? IterationPlan{} : IterationPlan{.rays = 1};
}

Estimate LinkedElements::trace(SolverState&, TracedIteration& iteration) {
    if (refines_next_) refines_ = refine_links();
    refines_next_ = false;
    state_.light.escaped_power = gather_light();
    if (importance_use(state_.light.solution) == ImportanceUse::full) gather_importance();
    ++sweeps_;
    const double change = std::max(light_change_, importance_change_);
    if (refines_)
        refines_next_ = change <= settled;
    else
        is_settled_ = change <= negligible_change;
    iteration.rays = rays_ - state_.rays.power;
    state_.rays.power = rays_;
    return {};
}

void LinkedElements::finish(SolverState& state) const {
    for (std::vector<float> Solution::*numbers :
         {&Solution::standard_error, &Solution::discretisation_error, &Solution::rays})
        (state.light.solution.*numbers).assign(state.light.forest->size(), 0.0f);
}

void LinkedElements::change_views(SolverState& state) {
    compute_view_importance(state);
    refines_ = state_.light.options().method.refines;
    refines_next_ = is_settled_ = false;
}

bool LinkedElements::is_consistent(const SolverState& state) const {
    const std::uint32_t elements = state.light.forest->size();
    const auto exists = [&](ElementIndex end) {
        return is_cluster(end) ? end - first_cluster < tree_.clusters().size() : end < elements;
    };
    const auto joins_elements = [&](const auto& link) { return exists(link.ends.a) && exists(link.ends.b); };
    return std::all_of(links_.begin(), links_.end(),
                       [&](const Link& link) { return joins_elements(link) && is_valid(link.exchange); }) &&
           std::all_of(candidates_.begin(), candidates_.end(), [&](const LinkCandidate& candidate) {
               const Effort effort = candidate.effort;
               return joins_elements(candidate) && (effort == Effort::quick || effort == Effort::thorough);
           });
}

void LinkedElements::archive(StateArchive& archive) {
    archive("links/links", links_);
    archive("links/candidates", candidates_);
    archive.amounts("links/light_change", light_change_);
    archive.amounts("links/importance_change", importance_change_);
    archive("links/rays", rays_);
    archive("links/sweeps", sweeps_);
    archive("links/refines", refines_);
    archive("links/refines_next", refines_next_);
    archive("links/is_settled", is_settled_);
}

std::unique_ptr<IterationMethod> make_linked_elements(SolverState& state) {
    return std::make_unique<LinkedElements>(state);
}

}  // namespace interflect::detail
