#include "interflect/solver/methods/baselines/link_radiosity.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "interflect/base/parallel.h"
#include "interflect/base/state_archive.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/refinement/oracle_threshold.h"

namespace interflect::detail {

struct RefinementCandidate {
    std::size_t link;
    std::uint32_t divided;
    double factor;  // error bound / threshold
};

namespace {

/// Relative change of light in a sweep below which links are refined, or the run ends.
constexpr double settled = 1e-2, negligible_change = 1e-6;
/// Relative error bound of 16 blocked lines of sight: a 17th may be free.
constexpr double bound_if_blocked = 1.0 / 16;
/// Maximum rays of the four links that replace one.
constexpr std::int64_t rays_per_division = std::int64_t{4} * 2 * 16;
constexpr std::size_t pairs_per_task = 256, patches_per_task = 8;

struct Sphere {
    V3f centre;
    float radius;
};

Sphere sphere_around(const Scene& scene, const Patch& patch) {
    Sphere sphere{PatchGeometry(scene, patch).centre(), 0};
    for (int k = 0; k < patch.vertex_count(); ++k) {
        const V3f& corner = scene.vertices[patch.vertices[static_cast<std::size_t>(k)]];
        sphere.radius = std::max(sphere.radius, (corner - sphere.centre).length());
    }
    return sphere;
}

/// Upper bound for surfaces inside two spheres [m^2].
double largest_exchange(const Sphere& a, const Sphere& b, double area_a, double area_b) {
    const double gap = std::max(0.0f, (a.centre - b.centre).length() - a.radius - b.radius);
    return area_a * area_b / (std::numbers::pi * gap * gap);
}

/// @param area_of  Link::area or Link::mean_area.
template <class T>
std::vector<T> gather(const ElementForest& forest, std::span<const Link> links, const std::vector<T>& leaving,
                      T (Link::*area_of)() const) {
    std::vector<T> received(forest.size(), T(0));
    for (const Link& link : links) {
        const auto [a, b] = link.ends;
        const T area = (link.*area_of)();
        received[a] += leaving[b] * area;
        received[b] += leaving[a] * area;
    }
    for (std::uint32_t e = 0; e < forest.size(); ++e) received[e] /= forest.area(e);
    push(forest, received);
    pull(forest, received);
    return received;
}

/// Counts non-finite values and sets them to 0.
std::vector<Rgb> present_radiosity(SolverState& state) {
    const Radiosity light(state.materials, state.solution.irradiance);
    std::vector<Rgb> b;
    b.reserve(state.forest->size());
    for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
        b.push_back(light.of(*state.forest, e));
        state.solution.non_finite += light.is_not_finite(*state.forest, e);
    }
    if (state.materials.has_textures()) pull(*state.forest, b);
    return b;
}

/// Area-weighted |new - old|, relative to the new value.
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
      forest_(*state.forest),
      estimator_(state.scene, *state.forest, state.ray_caster, state.options.seed),
      link_limit_(link_limit),
      refines_(state.options.method.refines) {}

void LinkedElements::require_room_for(std::size_t more) const {
    if (links_.size() + more <= link_limit_) return;
    throw InputError("'" + state_.scene.name + "' needs more than " + std::to_string(link_limit_) +
                     " links between its " + std::to_string(forest_.patch_count()) + " patches and their elements, " +
                     std::to_string(sizeof(Link)) +
                     " bytes each: raise epsilon or min_area, lower rays, or use a method without links, such as "
                     "hsrr");
}

void LinkedElements::prepare(SolverState&) {
    if (candidates_.empty()) find_patches_to_link();
    link_candidates();
}

void LinkedElements::find_patches_to_link() {
    double surface = 0;
    std::vector<Sphere> spheres;
    for (const Patch& patch : state_.scene.patches) spheres.push_back(sphere_around(state_.scene, patch));
    for (std::uint32_t i = 0; i < forest_.patch_count(); ++i) surface += forest_.area(i);
    const auto emits = [&](std::uint32_t i) { return channel_sum(state_.materials.exitance(i)) > 0; };
    // A reflector of average brightness sends at most the threshold over this exchange.
    const auto is_weak = [&](std::uint32_t i, std::uint32_t j) {
        return !emits(i) && !emits(j) &&
               largest_exchange(spheres[i], spheres[j], forest_.area(i), forest_.area(j)) <
                   state_.options.experimental.epsilon * surface;
    };

    std::vector<std::vector<LinkCandidate>> of_patch(forest_.patch_count());
    std::atomic<std::size_t> count{0};
    parallel_for_ranges(
        of_patch.size(), patches_per_task, state_.stop.within_process(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && count <= link_limit_; ++i) {
                const auto a = static_cast<std::uint32_t>(i);
                for (std::uint32_t b = a + 1; b < forest_.patch_count(); ++b)
                    if (estimator_.face_each_other({a, b}))
                        of_patch[i].push_back({{a, b}, is_weak(a, b) ? Effort::quick : Effort::thorough});
                count += of_patch[i].size();
            }
        });
    require_room_for(count);
    candidates_.reserve(count);
    for (const std::vector<LinkCandidate>& some : of_patch)
        candidates_.insert(candidates_.end(), some.begin(), some.end());
}

/// Drops pairs without unoccluded exchange.
void LinkedElements::link_candidates() {
    require_room_for(candidates_.size());
    std::vector<Link> made(candidates_.size());
    std::atomic<std::int64_t> rays{0};
    parallel_for_ranges(
        made.size(), pairs_per_task, state_.stop.within_process(), [&](std::size_t begin, std::size_t end) {
            std::int64_t used = 0;
            for (std::size_t i = begin; i < end; ++i)
                made[i] = {candidates_[i].ends, estimator_.estimate(candidates_[i].ends, candidates_[i].effort, used)};
            rays += used;
        });
    rays_ += rays;
    links_.insert(links_.end(), made.begin(), made.end());
    std::erase_if(links_, [](const Link& l) { return l.exchange.area == 0; });
    candidates_.clear();
}

RgbD LinkedElements::gather_light() {
    const std::vector<Rgb> b = present_radiosity(state_);
    const std::vector<RgbD> received = gather(forest_, links_, std::vector<RgbD>(b.begin(), b.end()), &Link::area);
    RelativeChange change;
    RgbD escaped = integral(forest_, b);
    for (std::uint32_t e = 0; e < forest_.size(); ++e) {
        Rgb& irradiance = state_.solution.irradiance[e];
        change.add(forest_.area(e), channel_sum(RgbD(irradiance)), channel_sum(received[e]));
        irradiance = Rgb(received[e]);
        const RgbD power = received[e] * static_cast<double>(forest_.area(e));
        if (e < forest_.patch_count()) escaped -= power;
        // A pane and the surface behind both receive transmitted light.
        if (forest_.is_leaf(e)) escaped += RgbD(state_.materials.surface(forest_.patch(e), e).transmittance) * power;
    }
    light_change_ = change.value();
    return escaped;
}

void LinkedElements::gather_importance() {
    const std::vector<float> psi = total_importance(state_.solution);
    std::vector<double> reflected(psi.size());
    for (std::uint32_t e = 0; e < forest_.size(); ++e)
        reflected[e] = static_cast<double>(state_.materials.mean_reflectance(forest_.patch(e), e)) * psi[e];
    if (state_.materials.has_textures()) pull(forest_, reflected);
    const std::vector<double> received = gather(forest_, links_, reflected, &Link::mean_area);
    RelativeChange change;
    for (std::uint32_t e = 0; e < forest_.size(); ++e) {
        float& importance = state_.solution.indirect_importance[e];
        change.add(forest_.area(e), importance, received[e]);
        importance = static_cast<float>(received[e]);
    }
    importance_change_ = change.value();
}

namespace {

struct RadiosityRange {
    std::vector<Rgb> least, most;

    RadiosityRange(const ElementForest& forest, const std::vector<Rgb>& b) : least(b), most(b) {
        for (std::uint32_t e = forest.size(); e-- > forest.patch_count();) {
            Rgb &low = least[forest.parent(e)], &high = most[forest.parent(e)];
            for (int c = 0; c < 3; ++c) {
                low[c] = std::min(low[c], least[e][c]);
                high[c] = std::max(high[c], most[e][c]);
            }
        }
    }
};

/// Returns [m^2], including partial occlusion.
double error_bound(const Exchange& exchange, float spread) {
    const float transmittance = largest_channel(exchange.transmittance);
    if (transmittance == 0) return exchange.area * bound_if_blocked;
    return exchange.variation * exchange.area + (1 - exchange.variation) * transmittance * spread;
}

}  // namespace

/// Each end has an error bound as receiver, with the other's radiosity, and as source, with the range of its own.
std::vector<RefinementCandidate> LinkedElements::refinement_candidates() const {
    const Solution& solution = state_.solution;
    const std::vector<Rgb> b = radiosity(state_.materials, forest_, solution.irradiance);
    const RadiosityRange range(forest_, b);
    const ImportanceUse use = importance_use(solution);
    const std::vector<float> psi =
        use == ImportanceUse::off ? std::vector<float>(b.size(), 1.0f) : total_importance(solution);
    const double threshold = solution.options.experimental.epsilon * reference_power(solution) *
                             (use == ImportanceUse::off ? 1 : reference_importance(solution, psi));
    std::vector<RefinementCandidate> candidates;
    if (!(threshold > 0)) return candidates;
    const auto weight = [&](std::uint32_t divided, std::uint32_t other) {
        const Rgb rho = state_.materials.surface(forest_.patch(divided), divided).reflectance,
                  rho_other = state_.materials.surface(forest_.patch(other), other).reflectance;
        const double as_receiver = largest_channel(rho * b[other]) * psi[divided];
        const double as_source = largest_channel(rho_other * (range.most[divided] - range.least[divided])) * psi[other];
        return may_divide(divided) ? std::max(as_receiver, as_source) : 0.0;
    };
    for (std::size_t i = 0; i < links_.size(); ++i) {
        const auto& [ends, exchange] = links_[i];
        const double over_a = weight(ends.a, ends.b) * error_bound(exchange, exchange.spread_over_a);
        const double over_b = weight(ends.b, ends.a) * error_bound(exchange, exchange.spread_over_b);
        if (std::max(over_a, over_b) > threshold)
            candidates.push_back({i, over_a > over_b ? ends.a : ends.b, std::max(over_a, over_b) / threshold});
    }
    return candidates;
}

bool LinkedElements::may_divide(std::uint32_t element) const {
    return forest_.area(element) >= 4.0 * static_cast<double>(state_.floor.default_min_area());
}

void LinkedElements::keep_affordable(std::vector<RefinementCandidate>& candidates) const {
    const std::int64_t rays = std::max<std::int64_t>(0, state_.options.limits.rays - rays_);
    const auto affordable = static_cast<std::size_t>(rays / rays_per_division);
    if (candidates.size() <= affordable) return;
    const auto comes_first = [](const RefinementCandidate& x, const RefinementCandidate& y) {
        return x.factor != y.factor ? x.factor > y.factor : x.link < y.link;
    };
    std::sort(candidates.begin(), candidates.end(), comes_first);
    candidates.resize(affordable);
}

void LinkedElements::describe_new_elements(std::uint32_t first) {
    Solution& solution = state_.solution;
    inherit(forest_, first, solution.irradiance);
    state_.materials.grow(forest_);
    if (state_.view.empty()) return;
    inherit(forest_, first, solution.indirect_importance);
    solution.view_importance = state_.view.per_area(forest_, state_.options.experimental.importance_at_patches);
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
        const std::uint32_t divided = candidate.divided;
        const std::uint32_t other = link.ends.a == divided ? link.ends.b : link.ends.a;
        const std::uint32_t child =
            forest_.is_leaf(divided) ? forest_.subdivide(divided) : forest_.first_child(divided);
        if (child == none) continue;
        const bool is_occluded = link.exchange.transmittance == Rgb(0) || link.exchange.variation > 0;
        const Effort effort = is_occluded ? Effort::thorough : Effort::quick;
        for (std::uint32_t k = 0; k < 4; ++k) candidates_.push_back({{child + k, other}, effort});
        link.exchange.area = 0;  // link_candidates() removes it
    }
    describe_new_elements(before);
}

bool LinkedElements::is_fulfilled(const SolverState& state) const {
    return is_settled_ ||
           (state.options.experimental.iterations > 0 && sweeps_ >= state.options.experimental.iterations);
}

IterationPlan LinkedElements::plan(SolverState& state) {
    return is_fulfilled(state) ? IterationPlan{} : IterationPlan{.rays = 1};
}

Estimate LinkedElements::trace(SolverState&, IterationPlan& plan) {
    if (refines_next_) refines_ = refine_links();
    refines_next_ = false;
    state_.escaped_power = gather_light();
    if (importance_use(state_.solution) == ImportanceUse::full) gather_importance();
    ++sweeps_;
    const double change = std::max(light_change_, importance_change_);
    if (refines_)
        refines_next_ = change <= settled;
    else
        is_settled_ = change <= negligible_change;
    plan.traced = rays_ - state_.power_rays;
    state_.power_rays = rays_;
    return {};
}

void LinkedElements::finish(SolverState& state) const {
    for (std::vector<float> Solution::*numbers :
         {&Solution::standard_error, &Solution::discretisation_error, &Solution::rays})
        (state.solution.*numbers).assign(state.forest->size(), 0.0f);
}

void LinkedElements::change_views(SolverState& state) {
    compute_view_importance(state);
    refines_ = state_.options.method.refines;
    refines_next_ = is_settled_ = false;
}

bool LinkedElements::fits(const SolverState& state) const {
    const std::uint32_t elements = state.forest->size();
    const auto joins_elements = [&](const auto& link) { return link.ends.a < elements && link.ends.b < elements; };
    return std::all_of(links_.begin(), links_.end(), joins_elements) &&
           std::all_of(candidates_.begin(), candidates_.end(), joins_elements);
}

void LinkedElements::archive(StateArchive& archive) {
    archive("links/links", links_);
    archive("links/candidates", candidates_);
    archive("links/light_change", light_change_);
    archive("links/importance_change", importance_change_);
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
