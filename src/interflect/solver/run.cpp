#include "interflect/solver/run.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/scene/split.h"
#include "interflect/solver/light.h"
#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// The incremental start ends when this share of the emitted power, or importance, has not been shot.
constexpr double negligible_unshot_power = 1e-3, negligible_unshot_importance = 0.005;

double smallest_area(const Scene& scene, const SolveOptions& options) {
    return options.smallest_area > 0 ? options.smallest_area : std::pow(default_element_size(scene), 2);
}

/// A step of rays may make more elements than are kept at its end (Oracle::most_elements): addresses are set aside for
/// as many as no step of a second or two makes.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    if (!options.method.refines) return scene.patches.size();
    if (options.method.scheme == Scheme::links) return options.most_elements;
    return std::min(largest, options.most_elements + excess);
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

bool goes_on(const Run& run, const BounceBudget& budget) {
    return !budget.is_spent() && !run.stop_is_asked_for() && !run.is_out_of_time();
}

/// @return The rays that it took.
std::int64_t start_importance(Run& run) {
    Solution& solution = run.solution;
    BounceBudget budget(run.schedule.start_rays(), run.options.rays / 4);
    std::vector<float> unshot = solution.view_importance;
    for (double left = 1; left > negligible_unshot_importance && goes_on(run, budget);) {
        TransportStep step = importance_step(run.surfaces, solution, Importance(unshot), budget.next(left));
        unshot = run_step(run, std::move(step)).importance;
        left = 0;  // of the reflected importance; at first all of V is to be shot
        for (std::uint32_t e = 0; e < run.forest->patch_count(); ++e) {
            solution.indirect_importance[e] += unshot[e];
            left += static_cast<double>(unshot[e]) * run.forest->area(e);
        }
    }
    run.importance_rays += budget.used();
    return budget.used();
}

/// @return The rays that it took.
std::int64_t start_power(Run& run, std::int64_t rays, RgbD& escaped_power) {
    Solution& solution = run.solution;
    BounceBudget budget(run.schedule.start_rays(), rays);
    const std::vector<Rgb> darkness = solution.irradiance;
    Light unshot(run.surfaces, darkness);
    Received received;
    const double emitted = channel_sum(solution.emitted_power);
    for (double left = 1; left > negligible_unshot_power && goes_on(run, budget);) {
        TransportStep step = power_step(run.surfaces, solution, unshot, false, budget.next(left));
        received = run_step(run, std::move(step));
        escaped_power += received.escaped_power;
        parallel_for_ranges(solution.irradiance.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
            for (std::size_t e = begin; e < end; ++e) solution.irradiance[e] += received.irradiance[e];
        });
        unshot = Light(run.surfaces, received.irradiance, false);
        left = channel_sum(radiated_power(*run.forest, unshot)) / emitted;
    }
    run.power_rays += budget.used();
    return budget.used();
}

}  // namespace

Run::Run(const Scene& scene, const RayCaster& caster, const SolveOptions& o, const Monitor& m)
    : surfaces(scene),
      ray_caster(caster),
      options(o),
      monitor(m),
      forest(std::make_shared<ElementForest>(scene, forest_capacity(scene, o))),
      view(o.views, o.seed),
      smallest_element(smallest_area(scene, o)),
      streams(o.points, o.seed),
      schedule(o, scene.patches.size()) {
    solution.forest = forest;
    solution.options = o;
    solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
    history.assign(forest->size(), 0.0f);
    variance.assign(forest->size(), 0.0f);
    solution.emitted_power = radiated_power(*forest, Light(surfaces, solution.irradiance));
    view.look(*forest, caster, o.eye_rays);
    if (view.empty()) return;
    solution.view_importance = view.per_area(*forest, !o.importance_at_elements);
    solution.indirect_importance.assign(forest->size(), 0.0f);
}

Received run_step(Run& run, TransportStep step) {
    const std::uint32_t before = run.forest->size();
    Received received = transport(run.surfaces, *run.forest, run.ray_caster, std::move(step), run.streams);
    run.escaped_rays += received.escaped_rays;
    if (run.forest->size() == before) return received;
    inherit(*run.forest, before, run.solution.irradiance);
    inherit(*run.forest, before, run.variance);
    inherit(*run.forest, before, run.history);
    if (run.view.empty()) return received;
    inherit(*run.forest, before, run.solution.indirect_importance);
    run.solution.view_importance = run.view.per_area(*run.forest, !run.options.importance_at_elements);
    return received;
}

void look_closer(Run& run) {
    constexpr std::int64_t rays_per_eye_ray = 64, most_eye_rays = 1 << 22;
    if (run.view.empty()) return;
    const std::int64_t wanted = std::min(run.schedule.averaged_rays() / rays_per_eye_ray, most_eye_rays);
    if (wanted < 2 * run.view.rays()) return;
    run.view.look(*run.forest, run.ray_caster, static_cast<int>((wanted - run.view.rays()) / run.view.views()));
    run.solution.view_importance = run.view.per_area(*run.forest, !run.options.importance_at_elements);
}

void start_incrementally(Run& run) {
    RgbD escaped_power(0, 0, 0);
    const bool with_importance = importance_use(run.solution) == ImportanceUse::full;
    const std::int64_t importance_rays = with_importance ? start_importance(run) : 0;
    const std::int64_t power_rays = start_power(run, run.options.rays - importance_rays, escaped_power);
    run.history.assign(run.forest->size(), static_cast<float>(power_rays));
    const bool is_averaged = run.options.method.scheme == Scheme::averaged;
    run.schedule.began_with(is_averaged ? power_rays : 0, importance_rays + (is_averaged ? 0 : power_rays));
    report(run, 0, escaped_power);
}

void estimate_error(Run& run, const std::vector<Rgb>& fresh, std::int64_t rays) {
    const Solution& solution = run.solution;
    const ElementForest& forest = *run.forest;
    const bool has_view = !run.view.empty();
    const auto n = static_cast<float>(rays), terms = static_cast<float>(run.error.terms() + 1);
    const auto add_some = [&](std::size_t begin, std::size_t end) {
        ErrorEstimate::Sums sums;
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            // Of each element's own: the spread of its luminance about the running mean, averaged over the iterations.
            const float difference = luminance(fresh[e] - solution.irradiance[e]);
            const float m = std::max(run.history[e], 1.0f);
            run.variance[e] += (difference * difference * (n * m / (n + m)) - run.variance[e]) / terms;
            if (!forest.is_leaf(e)) continue;
            const double area = forest.area(e);
            if (!has_view) {
                sums.add(area, luminance(solution.irradiance[e]), luminance(fresh[e]));
                continue;
            }
            // With a view, what counts is B; without, H, lest black surfaces count for nothing.
            const Material& material = run.surfaces.material(forest.patch(e));
            sums.add(area * static_cast<double>(solution.view_importance[e]),
                     luminance(material.exitance + material.reflectance * solution.irradiance[e]),
                     luminance(material.exitance + material.reflectance * fresh[e]));
        }
        return sums;
    };
    run.error.add(parallel_sum(forest.size(), elements_at_once, ErrorEstimate::Sums(), add_some),
                  run.schedule.averaged_rays(), rays);
}

void report(Run& run, int iteration, const RgbD& escaped_power) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = run.seconds();
    r.rays = run.schedule.rays();
    r.power_rays = run.power_rays;
    r.importance_rays = run.importance_rays;
    r.escaped_rays = run.escaped_rays;
    r.elements = run.forest->size();
    r.leaves = run.forest->patch_count() + (r.elements - run.forest->patch_count()) / 4 * 3;
    r.total_power = radiated_power(*run.forest, Light(run.surfaces, run.solution.irradiance));
    r.escaped_power = escaped_power;
    r.error_estimate = run.error.relative(run.schedule.averaged_rays());
    run.solution.iterations.push_back(r);
    if (run.monitor.report) run.monitor.report(r);
}

}  // namespace interflect
