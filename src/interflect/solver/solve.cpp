#include "interflect/solver/solve.h"

#include <ImathBox.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "interflect/base/error.h"
#include "interflect/solver/probabilities.h"
#include "interflect/solver/schedule.h"
#include "interflect/solver/surfaces.h"
#include "interflect/solver/transport.h"

namespace interflect {

namespace {

/// The incremental start ends when this share of the emitted power, or importance, has not been shot.
constexpr double negligible_unshot_power = 1e-3, negligible_unshot_importance = 0.005;
/// The smallest element is the square of the scene's diagonal over this, where the user sets no limit.
constexpr double diagonal_over_smallest = 1500;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void require_valid(const Scene& scene, const SolveOptions& o) {
    std::vector<std::string> faults = scene_faults(scene);
    const auto require = [&](bool holds, const char* message) {
        if (!holds) faults.emplace_back(message);
    };
    require(!scene.patches.empty(), "the scene has no patches");
    require(o.rays > 0, "rays: expected more than 0");
    require(o.seconds > 0, "seconds: expected more than 0");
    require(o.until >= 0 && o.until < 1, "until: expected a relative error from 0 to below 1");
    require(o.warm_up >= 0, "warm_up: expected 0 or more");
    require(o.iterations >= 0, "iterations: expected 0 or more");
    require(o.rays_per_iteration >= 0, "rays_per_iteration: expected 0 or more");
    require(o.epsilon > 0, "epsilon: expected more than 0");
    require(o.smallest_area >= 0, "smallest_area: expected 0 or more");
    require(o.most_elements >= scene.patches.size() && o.most_elements < 0xfffffff0u,
            "most_elements: expected at least the number of patches and less than 2^32 - 16");
    require(o.alpha >= 0 && o.alpha <= 1, "alpha: expected 0 to 1");
    require(o.beta >= 0 && o.beta <= 1, "beta: expected 0 to 1");
    require(o.eye_rays > 0, "eye_rays: expected more than 0");
    if (faults.empty()) return;
    std::string message = "cannot solve '" + scene.name + "':";
    for (const std::string& f : faults) message += "\n  " + f;
    throw InputError(message);
}

double smallest_area(const Scene& scene, const SolveOptions& options) {
    if (options.smallest_area > 0) return options.smallest_area;
    Imath::Box3f box;
    for (const V3f& v : scene.vertices) box.extendBy(v);
    return std::pow(box.size().length() / diagonal_over_smallest, 2);
}

/// The state of a run: everything that one iteration hands to the next.
struct Run {
    const Surfaces surfaces;
    const RayCaster& ray_caster;
    const SolveOptions& options;
    const std::shared_ptr<ElementForest> forest;
    const ViewImportance view;
    const double smallest_element;  // [m^2]
    SampleStreams streams;
    Schedule schedule;
    ErrorEstimate error;
    Solution solution;
    std::vector<float> history;  // of each element: rays that its mean stands for
    std::int64_t power_rays = 0, importance_rays = 0, escaped_rays = 0;
    Clock::time_point start = Clock::now();

    Run(const Scene& scene, const RayCaster& caster, const SolveOptions& o)
        : surfaces(scene),
          ray_caster(caster),
          options(o),
          forest(std::make_shared<ElementForest>(scene, o.method.refines ? o.most_elements : scene.patches.size())),
          view(o.views, *forest, caster, o.eye_rays, o.seed),
          smallest_element(smallest_area(scene, o)),
          streams(o.points, o.seed),
          schedule(o, scene.patches.size()) {
        solution.forest = forest;
        solution.method = o.method.name;
        solution.options = o;
        solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
        history.assign(forest->size(), 0.0f);
        solution.emitted_power = integral(*forest, radiosity(surfaces, *forest, solution.irradiance));
        if (view.empty()) return;
        solution.view_importance = view.per_area(*forest, !o.importance_at_elements);
        solution.indirect_importance.assign(forest->size(), 0.0f);
    }

    ImportanceUse importance_use() const { return view.empty() ? ImportanceUse::off : options.method.importance; }
    bool uses_bounces_of_importance() const { return importance_use() == ImportanceUse::full; }
};

/// psi of every element; what the oracle and the transport of importance know of the view.
std::vector<float> total_importance(const Run& run) {
    std::vector<float> psi = run.solution.view_importance;
    for (std::size_t e = 0; e < psi.size(); ++e) psi[e] += run.solution.indirect_importance[e];
    return psi;
}

/// Sets what is not finite to 0, so that it is not shot, and counts it.
void remove_non_finite(std::vector<Rgb>& radiosity, Solution& solution) {
    for (Rgb& b : radiosity) {
        if (is_finite(b)) continue;
        b = Rgb(0, 0, 0);
        ++solution.non_finite;
    }
}

/// Sampling weights of a step that carries power: Eq. 3, 9, 10, and 11 where it carries importance too.
std::vector<double> power_step_weights(const Run& run, const Sampled& s, bool combined) {
    std::vector<double> q(s.leaves.size(), 0.0);
    if (run.importance_use() == ImportanceUse::off) return power_weights(s);
    const SolveOptions& o = run.options;
    const double for_power = combined ? 1 - o.alpha : 1;
    if (!run.uses_bounces_of_importance())
        mix_in(q, view_weights(s), for_power * (1 - o.beta));
    else if (o.total_importance)
        mix_in(q, total_importance_weights(s), for_power * (1 - o.beta));
    else
        mix_in(q, indirect_importance_weights(s), for_power * (1 - o.beta));
    mix_in(q, power_weights(s), for_power * o.beta);
    if (combined) mix_in(q, importance_weights(s), o.alpha);
    return q;
}

/// The power that the oracle's threshold is relative to [lm or W]. With a view: what leaves the surfaces it sees, as if
/// all were as bright as they appear on average; so it does not depend on lights elsewhere, on how an emitter is
/// divided, or (times a length squared on both sides of Eq. 14) on the unit of length. Without a view: all emitted
/// power.
double reference_power(const Run& run, const std::vector<Rgb>& radiosity) {
    if (run.view.empty()) return channel_sum(run.solution.emitted_power) / 3;
    double seen = 0;  // sum of V B: the mean radiosity of the picture
    for (std::uint32_t e = 0; e < run.forest->patch_count(); ++e)
        seen += static_cast<double>(run.solution.view_importance[e]) * run.forest->area(e) *
                channel_sum(RgbD(radiosity[e])) / 3;
    return seen * run.view.seen_area(*run.forest);
}

/// psi_max of Eq. 15: the area-weighted mean of psi over the patches that the view sees.
double reference_importance(const Run& run, const std::vector<float>& psi) {
    double sum = 0, area = 0;
    for (std::uint32_t e = 0; e < run.forest->patch_count(); ++e) {
        if (!(run.solution.view_importance[e] > 0)) continue;
        sum += static_cast<double>(psi[e]) * run.forest->area(e);
        area += run.forest->area(e);
    }
    return area > 0 ? sum / area : 0;
}

Oracle make_oracle(const Run& run, const std::vector<Rgb>& radiosity, const std::vector<float>& psi) {
    Oracle oracle;
    oracle.refines = true;
    oracle.by_importance = run.importance_use() != ImportanceUse::off;
    oracle.threshold = run.options.epsilon * reference_power(run, radiosity) *
                       (oracle.by_importance ? reference_importance(run, psi) : 1);
    oracle.smallest_area = static_cast<float>(run.smallest_element);
    return oracle;
}

/// Traces a step's rays; afterwards everything kept by element has grown with the forest.
Received run_step(Run& run, const TransportStep& step) {
    const std::uint32_t before = run.forest->size();
    Received received = transport(run.surfaces, *run.forest, run.ray_caster, step, run.streams);
    run.escaped_rays += received.escaped_rays;
    inherit(*run.forest, before, run.solution.irradiance);
    inherit(*run.forest, before, run.history);
    for (std::uint32_t e = before; e < run.forest->size(); ++e)
        if (run.forest->parent(e) < before) run.history[e] *= static_cast<float>(run.options.inherited_trust);
    if (run.view.empty()) return received;
    inherit(*run.forest, before, run.solution.indirect_importance);
    run.solution.view_importance = run.view.per_area(*run.forest, !run.options.importance_at_elements);
    return received;
}

/// Eq. 6 with a tau for each element: what N rays brought, among the rays that its mean stands for so far. Where no
/// element is new, that is the same tau for all.
template <class T>
void merge(const Run& run, std::vector<T>& mean, const std::vector<T>& received, const IterationPlan& plan) {
    const auto rays = static_cast<float>(plan.rays);
    for (std::size_t e = 0; e < mean.size(); ++e) {
        const float tau = plan.warms_up ? 1.0f : rays / (run.history[e] + rays);
        mean[e] += tau * (received[e] - mean[e]);
    }
    pull(*run.forest, mean);
}

void remember(Run& run, const IterationPlan& plan) {
    for (float& rays : run.history) rays = plan.warms_up ? 0.0f : rays + static_cast<float>(plan.rays);
}

TransportStep importance_step(const Run& run, const std::vector<float>& psi, std::int64_t rays) {
    TransportStep step;
    step.leaves = run.forest->leaves();
    const std::vector<Rgb> no_radiosity;
    const std::vector<float> no_bounces;
    step.q = importance_weights({run.surfaces, *run.forest, step.leaves, no_radiosity, psi, no_bounces});
    step.rays = rays;
    step.importance = psi;
    step.carries_importance = true;
    step.importance_at_patches = !run.options.importance_at_elements;
    return step;
}

/// A step that carries power; `combined`: and importance.
TransportStep power_step(const Run& run, std::vector<Rgb> radiosity, bool combined, std::int64_t rays) {
    TransportStep step;
    step.leaves = run.forest->leaves();
    step.q = power_step_weights(run,
                                {run.surfaces, *run.forest, step.leaves, radiosity, run.solution.view_importance,
                                 run.solution.indirect_importance},
                                combined);
    step.rays = rays;
    step.radiosity = std::move(radiosity);
    step.importance = total_importance(run);
    step.carries_importance = combined;
    step.importance_at_patches = !run.options.importance_at_elements;
    return step;
}

/// Enters the difference between a new iteration and the running mean into the estimate of the error.
void estimate_error(Run& run, const Received& received, std::int64_t rays) {
    const std::vector<std::uint32_t> leaves = run.forest->leaves();
    std::vector<double> weights(leaves.size()), mean(leaves.size()), fresh(leaves.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const std::uint32_t e = leaves[i], patch = run.forest->patch(e);
        const double area = run.forest->area(e);
        // With a view, what counts is B; without, H, lest black surfaces count for nothing.
        const Rgb scale = run.view.empty() ? Rgb(1) : run.surfaces.reflectance(patch);
        const Rgb offset = run.view.empty() ? Rgb(0) : run.surfaces.exitance(patch);
        weights[i] = run.view.empty() ? area : area * static_cast<double>(run.solution.view_importance[e]);
        mean[i] = luminance(offset + scale * run.solution.irradiance[e]);
        fresh[i] = luminance(offset + scale * received.irradiance[e]);
    }
    run.error.add(weights, mean, run.schedule.averaged_rays(), fresh, rays);
}

void report(Run& run, int iteration, const RgbD& escaped_power, const Monitor& monitor) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = seconds_since(run.start);
    r.rays = run.schedule.rays();
    r.power_rays = run.power_rays;
    r.importance_rays = run.importance_rays;
    r.escaped_rays = run.escaped_rays;
    r.elements = run.forest->size();
    r.leaves = run.forest->patch_count() + (r.elements - run.forest->patch_count()) / 4 * 3;
    r.total_power = integral(*run.forest, radiosity(run.surfaces, *run.forest, run.solution.irradiance));
    r.escaped_power = escaped_power;
    r.error_estimate = run.error.relative(run.schedule.averaged_rays());
    run.solution.iterations.push_back(r);
    if (monitor.report) monitor.report(r);
}

/// How many rays each bounce of the incremental start gets: in proportion to what is left to shoot; but if all bounces
/// to come decay alike, they must do with half of the budget.
class BounceBudget {
  public:
    BounceBudget(std::int64_t first_bounce, std::int64_t budget) : first_bounce_(first_bounce), budget_(budget) {}

    /// @param left  What is left, as a share of what there was at first.
    std::int64_t next(double left) {
        const double decay = last_left_ > 0 ? left / last_left_ : 0;
        last_left_ = left;
        const double affordable = 0.5 * (1 - std::min(decay, 1.0)) * static_cast<double>(budget_);
        const double share = static_cast<double>(first_bounce_) * left;
        const std::int64_t rays = std::max<std::int64_t>(1, std::llround(std::min(share, affordable)));
        budget_ -= rays;
        used_ += rays;
        return rays;
    }
    bool is_spent() const { return budget_ <= 0; }
    std::int64_t used() const { return used_; }

  private:
    std::int64_t first_bounce_, budget_, used_ = 0;
    double last_left_ = 0;
};

/// Follows importance from the eye bounce by bounce, on the patches as they are.
std::int64_t start_importance(Run& run) {
    BounceBudget budget(run.schedule.start_rays(), run.options.rays / 4);
    std::vector<float> unshot = run.solution.view_importance;
    for (double left = 1; left > negligible_unshot_importance && !budget.is_spent();) {
        const Received received = run_step(run, importance_step(run, unshot, budget.next(left)));
        unshot = received.importance;
        left = 0;  // of the reflected importance; at first all of V is to be shot
        for (std::uint32_t e = 0; e < run.forest->patch_count(); ++e) {
            run.solution.indirect_importance[e] += unshot[e];
            left += static_cast<double>(unshot[e]) * run.forest->area(e);
        }
    }
    run.importance_rays += budget.used();
    return budget.used();
}

/// Follows the light bounce by bounce, shooting only what has not been shot: an estimate of all bounces in which no ray
/// is thrown away ('incremental shooting', Neumann et al. 1995). The mesh stays as it is.
std::int64_t start_power(Run& run, std::int64_t rays, RgbD& escaped_power) {
    BounceBudget budget(run.schedule.start_rays(), rays);
    std::vector<Rgb> unshot = radiosity(run.surfaces, *run.forest, run.solution.irradiance);
    const double emitted = channel_sum(run.solution.emitted_power);
    for (double left = 1; left > negligible_unshot_power && !budget.is_spent();) {
        const Received received = run_step(run, power_step(run, std::move(unshot), false, budget.next(left)));
        escaped_power += received.escaped_power;
        unshot.resize(run.forest->size());
        for (std::uint32_t e = 0; e < run.forest->size(); ++e) {
            run.solution.irradiance[e] += received.irradiance[e];
            unshot[e] = run.surfaces.reflectance(run.forest->patch(e)) * received.irradiance[e];
        }
        left = channel_sum(integral(*run.forest, unshot)) / emitted;
    }
    run.power_rays += budget.used();
    return budget.used();
}

void start_incrementally(Run& run, const Monitor& monitor) {
    RgbD escaped_power(0, 0, 0);
    const std::int64_t importance_rays = run.uses_bounces_of_importance() ? start_importance(run) : 0;
    const std::int64_t power_rays = start_power(run, run.options.rays - importance_rays, escaped_power);
    run.history.assign(run.forest->size(), static_cast<float>(power_rays));
    run.schedule.began_with(power_rays, importance_rays);
    report(run, 0, escaped_power, monitor);
}

/// One iteration: what is received in one bounce of the present estimate, merged with the past.
void iterate(Run& run, const IterationPlan& plan, int iteration, const Monitor& monitor) {
    const bool with_importance = run.uses_bounces_of_importance();
    const bool combined = with_importance && !run.options.separate_iterations;
    const auto for_importance =
        with_importance ? std::llround(run.options.alpha * static_cast<double>(plan.rays)) : std::int64_t{0};
    run.importance_rays += for_importance;
    run.power_rays += plan.rays - for_importance;
    if (with_importance && !combined && for_importance > 0) {
        const Received received = run_step(run, importance_step(run, total_importance(run), for_importance));
        merge(run, run.solution.indirect_importance, received.importance, plan);
    }
    RgbD escaped_power(0, 0, 0);
    const std::int64_t rays = combined ? plan.rays : plan.rays - for_importance;
    if (rays > 0) {
        std::vector<Rgb> b = radiosity(run.surfaces, *run.forest, run.solution.irradiance);
        remove_non_finite(b, run.solution);
        TransportStep step = power_step(run, std::move(b), combined, rays);
        const bool deferred = run.options.defer_refinement && plan.warms_up;
        if (run.options.method.refines && !deferred) step.oracle = make_oracle(run, step.radiosity, step.importance);
        const Received received = run_step(run, step);
        if (run.schedule.averaged_rays() > 0) estimate_error(run, received, rays);
        merge(run, run.solution.irradiance, received.irradiance, plan);
        if (combined) merge(run, run.solution.indirect_importance, received.importance, plan);
        escaped_power = received.escaped_power;
    }
    remember(run, plan);
    run.schedule.done(plan);
    report(run, iteration, escaped_power, monitor);
}

bool reached(const Run& run, double relative_error) {
    return relative_error > 0 && run.error.relative(run.schedule.averaged_rays()) <= relative_error;
}

}  // namespace

const Method& find_method(const std::string& name) {
    std::string known;
    for (const Method& method : methods) {
        if (name == method.name) return method;
        known += (known.empty() ? "" : ", ") + std::string(method.name);
    }
    throw InputError("there is no method '" + name + "'; there are: " + known);
}

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    require_valid(scene, options);
    Run run(scene, ray_caster, options);
    if (!(channel_sum(run.solution.emitted_power) > 0)) return std::move(run.solution);  // dark, and exactly so
    if (options.incremental_start) start_incrementally(run, monitor);
    for (int iteration = 1; !reached(run, options.until); ++iteration) {
        const IterationPlan plan = run.schedule.next(seconds_since(run.start));
        if (plan.rays == 0) break;
        if (monitor.stop && monitor.stop->load()) {
            run.solution.interrupted = true;
            break;
        }
        iterate(run, plan, iteration, monitor);
    }
    return std::move(run.solution);
}

}  // namespace interflect
