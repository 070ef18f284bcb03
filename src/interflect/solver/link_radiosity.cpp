#include "interflect/solver/link_radiosity.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/exchange.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/solver_state.h"
#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// Light has settled enough to refine by, and for good, when a sweep changes no more than this share of it.
constexpr double settled = 1e-2, negligible_change = 1e-6;
/// Where all lines of sight were blocked, the error bound is this share of what the link would carry unoccluded: of
/// as many as were tried, the next may be free.
constexpr double bound_if_blocked = 1.0 / 16;
/// Most rays for the four links that replace one.
constexpr std::int64_t rays_per_division = std::int64_t{4} * 2 * 16;
/// Of one task.
constexpr std::size_t pairs_per_task = 256, patches_per_task = 8;

struct Link {
    ElementPair ends;
    Exchange exchange;

    double area() const { return static_cast<double>(exchange.area) * static_cast<double>(exchange.visibility); }
};

/// Two elements that are to be linked.
struct LinkCandidate {
    ElementPair ends;
    Effort effort;
};

/// A link whose error bound exceeds the threshold, and which of its elements is to be subdivided.
struct RefinementCandidate {
    std::size_t link;
    std::uint32_t divided;
    double factor;  // over the threshold
};

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

/// The most that what lies in two spheres exchanges [m^2].
double largest_exchange(const Sphere& a, const Sphere& b, double area_a, double area_b) {
    const double gap = std::max(0.0f, (a.centre - b.centre).length() - a.radius - b.radius);
    return area_a * area_b / (std::numbers::pi * gap * gap);
}

/// What every element receives, per unit of area, of what leaves each of the elements that it is linked to.
template <class T>
std::vector<T> gather(const ElementForest& forest, std::span<const Link> links, const std::vector<T>& leaving) {
    std::vector<T> received(forest.size(), T(0));
    for (const Link& link : links) {
        const auto [a, b] = link.ends;
        received[a] += leaving[b] * link.area();
        received[b] += leaving[a] * link.area();
    }
    for (std::uint32_t e = 0; e < forest.size(); ++e) received[e] /= forest.area(e);
    push(forest, received);
    pull(forest, received);
    return received;
}

/// B of every element; what is not finite is set to 0, so that it is not gathered, and counted.
std::vector<Rgb> present_radiosity(SolverState& state) {
    const Radiosity light(state.materials, state.solution.irradiance);
    std::vector<Rgb> b;
    b.reserve(state.forest->size());
    for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
        b.push_back(light.of(*state.forest, e));
        state.solution.non_finite += light.is_lost(*state.forest, e);
    }
    return b;
}

/// Sum over the elements of area times |new - old|, relative to that of area times new.
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

class LinkedElements {
  public:
    LinkedElements(const Scene& scene, SolverState& state, std::size_t link_limit)
        : scene_(scene),
          state_(state),
          forest_(*state.forest),
          estimator_(*state.forest, state.ray_caster, state.options.seed),
          link_limit_(link_limit) {}

    /// Links all patches that face each other.
    void link_patches();
    /// Carries light one bounce further. @return what arrived at no element.
    RgbD gather_light();
    /// Carries importance one bounce further, against the light.
    void gather_importance();
    /// Of the last bounce.
    double change() const { return std::max(light_change_, importance_change_); }
    /// Subdivides links whose error bound exceeds the threshold. @return whether any was.
    bool refine();

    std::int64_t rays() const { return rays_; }

  private:
    void require_room_for(std::size_t more) const;
    void link(const std::vector<LinkCandidate>& link_candidates);
    std::vector<RefinementCandidate> refinement_candidates() const;
    bool may_divide(std::uint32_t element) const;
    void keep_affordable(std::vector<RefinementCandidate>& candidates) const;
    void describe_new_elements(std::uint32_t first);

    const Scene& scene_;
    SolverState& state_;
    ElementForest& forest_;
    ExchangeEstimator estimator_;
    std::size_t link_limit_;
    std::vector<Link> links_;
    double light_change_ = 0, importance_change_ = 0;
    std::int64_t rays_ = 0;
};

void LinkedElements::require_room_for(std::size_t more) const {
    if (links_.size() + more <= link_limit_) return;
    throw InputError("'" + scene_.name + "' needs more than " + std::to_string(link_limit_) + " links between its " +
                     std::to_string(forest_.patch_count()) + " patches and their elements, " +
                     std::to_string(sizeof(Link)) +
                     " bytes each: raise epsilon or min_area, lower rays, or use a method without links, such as "
                     "hsrr");
}

void LinkedElements::link_patches() {
    double surface = 0;
    std::vector<Sphere> spheres;
    for (const Patch& patch : scene_.patches) spheres.push_back(sphere_around(scene_, patch));
    for (std::uint32_t i = 0; i < forest_.patch_count(); ++i) surface += forest_.area(i);
    const auto emits = [&](std::uint32_t i) { return channel_sum(state_.materials.exitance(i)) > 0; };
    // A reflector as bright as the average sends no more than the threshold over so small an exchange.
    const auto is_weak = [&](std::uint32_t i, std::uint32_t j) {
        return !emits(i) && !emits(j) &&
               largest_exchange(spheres[i], spheres[j], forest_.area(i), forest_.area(j)) <
                   state_.options.epsilon * surface;
    };

    std::vector<std::vector<LinkCandidate>> of_patch(forest_.patch_count());
    std::atomic<std::size_t> count{0};
    parallel_for_ranges(of_patch.size(), patches_per_task, state_.stop, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && count <= link_limit_; ++i) {
            const auto a = static_cast<std::uint32_t>(i);
            for (std::uint32_t b = a + 1; b < forest_.patch_count(); ++b)
                if (estimator_.face_each_other({a, b}))
                    of_patch[i].push_back({{a, b}, is_weak(a, b) ? Effort::quick : Effort::thorough});
            count += of_patch[i].size();
        }
    });
    require_room_for(count);
    std::vector<LinkCandidate> all;
    all.reserve(count);
    for (const std::vector<LinkCandidate>& link_candidates : of_patch)
        all.insert(all.end(), link_candidates.begin(), link_candidates.end());
    link(all);
}

/// Adds links, but none between elements that exchange nothing even unoccluded.
void LinkedElements::link(const std::vector<LinkCandidate>& link_candidates) {
    require_room_for(link_candidates.size());
    const std::size_t first = links_.size();
    links_.resize(first + link_candidates.size());
    std::atomic<std::int64_t> rays{0};
    parallel_for_ranges(link_candidates.size(), pairs_per_task, state_.stop, [&](std::size_t begin, std::size_t end) {
        std::int64_t used = 0;
        for (std::size_t i = begin; i < end; ++i)
            links_[first + i] = {link_candidates[i].ends,
                                 estimator_.estimate(link_candidates[i].ends, link_candidates[i].effort, used)};
        rays += used;
    });
    rays_ += rays;
    std::erase_if(links_, [](const Link& l) { return l.exchange.area == 0; });
}

RgbD LinkedElements::gather_light() {
    const std::vector<Rgb> b = present_radiosity(state_);
    const std::vector<RgbD> received = gather(forest_, links_, std::vector<RgbD>(b.begin(), b.end()));
    RelativeChange change;
    RgbD escaped = integral(forest_, b);
    for (std::uint32_t e = 0; e < forest_.size(); ++e) {
        Rgb& irradiance = state_.solution.irradiance[e];
        change.add(forest_.area(e), channel_sum(RgbD(irradiance)), channel_sum(received[e]));
        irradiance = Rgb(received[e]);
        if (e < forest_.patch_count()) escaped -= received[e] * static_cast<double>(forest_.area(e));
    }
    light_change_ = change.value();
    return escaped;
}

void LinkedElements::gather_importance() {
    const std::vector<float> psi = total_importance(state_.solution);
    std::vector<double> reflected(psi.size());
    for (std::uint32_t e = 0; e < forest_.size(); ++e)
        reflected[e] = static_cast<double>(state_.materials.mean_reflectance(forest_.patch(e))) * psi[e];
    const std::vector<double> received = gather(forest_, links_, reflected);
    RelativeChange change;
    for (std::uint32_t e = 0; e < forest_.size(); ++e) {
        float& importance = state_.solution.indirect_importance[e];
        change.add(forest_.area(e), importance, received[e]);
        importance = static_cast<float>(received[e]);
    }
    importance_change_ = change.value();
}

/// The largest and the smallest radiosity of each element's parts.
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

/// Bound on the error of what a link carries [m^2]: the variation of the form factor; all of it where partly occluded.
double error_bound(const Exchange& exchange, float spread) {
    if (exchange.visibility == 0) return exchange.area * bound_if_blocked;
    return exchange.visibility < 1 ? exchange.area : spread;
}

/// What the links carry wrongly at most, after Smits et al. 1992: what element i receives from j is taken as the same
/// all over i, where the form factor varies by its spread over i times B_j, and by its spread over j times the
/// difference between the brightest and the darkest parts of j. Each counts against the element that, divided, amends
/// it; both directions are looked at, the worse counts.
std::vector<RefinementCandidate> LinkedElements::refinement_candidates() const {
    const Solution& solution = state_.solution;
    const std::vector<Rgb> b = radiosity(state_.materials, forest_, solution.irradiance);
    const RadiosityRange range(forest_, b);
    const ImportanceUse use = importance_use(solution);
    const std::vector<float> psi =
        use == ImportanceUse::off ? std::vector<float>(b.size(), 1.0f) : total_importance(solution);
    const double threshold = solution.options.epsilon * reference_power(solution) *
                             (use == ImportanceUse::off ? 1 : reference_importance(solution, psi));
    std::vector<RefinementCandidate> candidates;
    if (!(threshold > 0)) return candidates;
    const auto weight = [&](std::uint32_t divided, std::uint32_t other) {
        const Rgb &rho = state_.materials.reflectance(forest_.patch(divided)),
                  &rho_other = state_.materials.reflectance(forest_.patch(other));
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
    return forest_.area(element) >= 4.0 * static_cast<double>(state_.floor.unseen());
}

/// Where not all can be divided, keeps the worst.
void LinkedElements::keep_affordable(std::vector<RefinementCandidate>& candidates) const {
    const std::int64_t rays = std::max<std::int64_t>(0, state_.options.rays - rays_);
    const auto affordable = static_cast<std::size_t>(rays / rays_per_division);
    if (candidates.size() <= affordable) return;
    const auto comes_first = [](const RefinementCandidate& x, const RefinementCandidate& y) {
        return x.factor != y.factor ? x.factor > y.factor : x.link < y.link;
    };
    std::sort(candidates.begin(), candidates.end(), comes_first);
    candidates.resize(affordable);
}

/// The elements that came last are their parents' parts: until the next sweep they are as bright.
void LinkedElements::describe_new_elements(std::uint32_t first) {
    Solution& solution = state_.solution;
    inherit(forest_, first, solution.irradiance);
    if (state_.view.empty()) return;
    inherit(forest_, first, solution.indirect_importance);
    solution.view_importance = state_.view.per_area(forest_, !state_.options.importance_at_elements);
}

bool LinkedElements::refine() {
    std::vector<RefinementCandidate> candidates = refinement_candidates();
    keep_affordable(candidates);
    const std::uint32_t before = forest_.size();
    std::vector<LinkCandidate> link_candidates;
    for (const RefinementCandidate& candidate : candidates) {
        Link& link = links_[candidate.link];
        const std::uint32_t divided = candidate.divided;
        const std::uint32_t other = link.ends.a == divided ? link.ends.b : link.ends.a;
        const std::uint32_t child =
            forest_.is_leaf(divided) ? forest_.subdivide(divided) : forest_.first_child(divided);
        if (child == none) continue;
        const Effort effort = link.exchange.visibility == 1 ? Effort::quick : Effort::thorough;
        for (std::uint32_t k = 0; k < 4; ++k) link_candidates.push_back({{child + k, other}, effort});
        link.exchange.area = 0;  // link() removes it
    }
    describe_new_elements(before);
    link(link_candidates);
    return !link_candidates.empty();
}

/// Sweeps until light and links have settled, or a limit is reached. @throws Interrupted in the middle of a sweep
void sweep(SolverState& state, LinkedElements& elements) {
    elements.link_patches();
    bool refines = state.options.method.refines;
    for (int iteration = 1;; ++iteration) {
        const RgbD escaped_power = elements.gather_light();
        if (importance_use(state.solution) == ImportanceUse::full) elements.gather_importance();
        state.schedule.done({elements.rays() - state.power_rays, false});
        state.power_rays = elements.rays();
        report(state, iteration, escaped_power);
        if (state.options.iterations > 0 && iteration >= state.options.iterations) return;
        if (state.stop.is_due()) throw Interrupted();
        if (refines && elements.change() <= settled)
            refines = elements.refine();
        else if (!refines && elements.change() <= negligible_change)
            return;
    }
}

}  // namespace

Solution solve_by_links(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                        const Monitor& monitor, std::size_t link_limit) {
    SolverState state(scene, ray_caster, options, monitor);
    state.stop.limit_time(state.start, options.seconds);
    LinkedElements elements(scene, state, link_limit);
    const bool is_lit = channel_sum(state.solution.emitted_power) > 0;  // else it is dark, and exactly so
    try {
        if (is_lit) sweep(state, elements);
    } catch (const Interrupted&) {
        state.solution.interrupted = state.stop.is_asked_for();
    }
    state.solution.standard_error.assign(state.forest->size(), 0.0f);
    state.solution.discretisation_error.assign(state.forest->size(), 0.0f);
    state.solution.rays.assign(state.forest->size(), 0.0f);
    return std::move(state.solution);
}

}  // namespace interflect
