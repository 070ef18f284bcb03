#include "interflect/solver/solve.h"

#include <chrono>
#include <cmath>

#include "interflect/base/error.h"
#include "interflect/solver/schedule.h"
#include "interflect/solver/surfaces.h"
#include "interflect/solver/transport.h"

namespace interflect {

namespace {

/// The incremental start ends when this share of the emitted power has not been shot.
constexpr double negligible_unshot = 1e-3;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void require_valid(const Scene& scene, const SolveOptions& o) {
    std::vector<std::string> faults = scene_faults(scene);
    if (scene.patches.empty()) faults.emplace_back("the scene has no patches");
    const auto fault = [&](bool is_fault, const char* message) {
        if (is_fault) faults.emplace_back(message);
    };
    fault(o.rays <= 0, "rays: expected more than 0");
    fault(!(o.seconds > 0), "seconds: expected more than 0");
    fault(!(o.until >= 0 && o.until < 1), "until: expected a relative error from 0 to below 1");
    fault(o.warm_up < 0, "warm_up: expected 0 or more");
    fault(o.iterations < 0, "iterations: expected 0 or more");
    fault(o.rays_per_iteration < 0, "rays_per_iteration: expected 0 or more");
    if (faults.empty()) return;
    std::string message = "cannot solve '" + scene.name + "':";
    for (const std::string& f : faults) message += "\n  " + f;
    throw InputError(message);
}

/// The state of a run: everything that one iteration hands to the next.
struct Run {
    const Surfaces surfaces;
    const RayCaster& ray_caster;
    SampleStreams streams;
    Schedule schedule;
    ErrorEstimate error;
    Solution solution;
    std::int64_t escaped_rays = 0;
    Clock::time_point start = Clock::now();

    Run(const Scene& scene, const RayCaster& caster, const SolveOptions& options)
        : surfaces(scene),
          ray_caster(caster),
          streams(options.points, options.seed, scene.patches.size()),
          schedule(options, scene.patches.size()) {
        solution.options = options;
        solution.irradiance.assign(surfaces.size(), Rgb(0, 0, 0));
        solution.emitted_power = total(radiated_power(surfaces, solution.irradiance));
    }
};

/// Shoots `power` with N rays; returns the irradiance R_i / A_i that it makes.
std::vector<Rgb> irradiance_from(Run& run, const std::vector<Rgb>& power, std::int64_t rays, RgbD& escaped_power) {
    Received received = receive_power(run.surfaces, run.ray_caster, power, power_weights(power), rays, run.streams);
    run.solution.non_finite += received.non_finite;
    run.escaped_rays += received.escaped_rays;
    escaped_power += received.escaped_power;
    for (std::size_t i = 0; i < received.power.size(); ++i) received.power[i] /= run.surfaces.area(i);
    return std::move(received.power);
}

void report(Run& run, int iteration, const RgbD& escaped_power, const Monitor& monitor) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = seconds_since(run.start);
    r.rays = run.schedule.rays();
    r.escaped_rays = run.escaped_rays;
    r.total_power = total(radiated_power(run.surfaces, run.solution.irradiance));
    r.escaped_power = escaped_power;
    r.error_estimate = run.error.relative(run.schedule.averaged_rays());
    run.solution.iterations.push_back(r);
    if (monitor.report) monitor.report(r);
}

/// Follows the light bounce by bounce, shooting only what has not been shot: an estimate of all bounces in which no ray
/// is thrown away ('incremental shooting', Neumann et al. 1995).
void start_incrementally(Run& run, const Monitor& monitor) {
    std::vector<Rgb> unshot = radiated_power(run.surfaces, run.solution.irradiance);
    const double emitted = channel_sum(run.solution.emitted_power);
    RgbD escaped_power(0, 0, 0);
    std::int64_t budget = run.solution.options.rays;
    double left = emitted, decay = 0;  // unshot power, and by what it fell in the last bounce
    while (left > negligible_unshot * emitted && budget > 0) {
        // Rays in proportion to power; but if all bounces to come decay alike, they must do with half of the budget.
        const double share = static_cast<double>(run.schedule.start_rays()) * left / emitted;
        const double affordable = 0.5 * (1 - decay) * static_cast<double>(budget);
        const std::int64_t rays = std::max<std::int64_t>(1, std::llround(std::min(share, affordable)));
        const std::vector<Rgb> received = irradiance_from(run, unshot, rays, escaped_power);
        budget -= rays;
        for (std::size_t i = 0; i < unshot.size(); ++i) {
            run.solution.irradiance[i] += received[i];
            unshot[i] = run.surfaces.area(i) * run.surfaces.reflectance(i) * received[i];
        }
        const double reflected = channel_sum(total(unshot));
        decay = reflected / left;
        left = reflected;
    }
    run.schedule.began_with(run.solution.options.rays - budget);
    report(run, 0, escaped_power, monitor);
}

void iterate(Run& run, const IterationPlan& plan, int iteration, const Monitor& monitor) {
    std::vector<Rgb>& irradiance = run.solution.irradiance;
    const std::vector<Rgb> power = radiated_power(run.surfaces, irradiance);
    RgbD escaped_power(0, 0, 0);
    const std::vector<Rgb> received = irradiance_from(run, power, plan.rays, escaped_power);  // Eq. 1
    if (plan.tau < 1) run.error.add(run.surfaces, irradiance, run.schedule.averaged_rays(), received, plan.rays);
    const auto tau = static_cast<float>(plan.tau);
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        irradiance[i] += tau * (received[i] - irradiance[i]);  // Eq. 6, Prikryl et al. 2000
    run.schedule.done(plan);
    report(run, iteration, escaped_power, monitor);
}

bool reached(const Run& run, double relative_error) {
    return relative_error > 0 && run.error.relative(run.schedule.averaged_rays()) <= relative_error;
}

}  // namespace

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
