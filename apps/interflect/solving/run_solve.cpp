#include "apps/interflect/solving/run_solve.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "apps/interflect/console/progress.h"
#include "apps/interflect/processes/shared_run.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/values/percent.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"
#include "interflect/leaks.h"
#include "interflect/prepare.h"
#include "interflect/solution.h"
#include "interflect/summary.h"

namespace interflect::command {

using namespace detail;

namespace {

void warn_of_leaks(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    if (solution.iterations.empty() || solution.iterations.back().escaped_rays == 0) return;
    const Escapes escapes = find_escapes(scene, ray_caster, solution);
    if (escapes.is_leak())
        spdlog::warn(
            "the scene looks closed but leaks: {} of the light leaves it, most of that through gaps "
            "between faces",
            percent(escapes.share()));
}

/// Warns if one-sided faces stop light but not reversed paths, or the reverse.
void warn_of_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    constexpr double min_share = 0.02, min_reflected = 0.01;  // of all received light
    const OneWayLight found = find_one_way_light(scene, ray_caster, solution);
    if (std::abs(found.share) < min_share && std::abs(found.reflected_share) < min_reflected) return;
    const bool is_bright = found.share > 0;
    const bool has_name = found.object < scene.objects.size() && !scene.objects[found.object].empty();
    spdlog::warn(
        "the solution is too {} by {}, light gathered from it by {}: {}, most of it in '{}' (material '{}'); faces "
        "that keep light in or out need two sides",
        is_bright ? "bright" : "dark", percent(std::abs(found.share)), percent(std::abs(found.reflected_share)),
        is_bright ? "light goes through the backs of one-sided faces, whose fronts stop path tracing and gathering"
                  : "the fronts of one-sided faces stop light that path tracing and gathering see through the backs",
        has_name ? scene.objects[found.object] : scene.name, scene.materials[found.material].name);
}

/// Compares emitted with absorbed and escaped power; the difference indicates the solution's error.
std::string text_of_balance(const Scene& scene, const Solution& solution) {
    const PowerBalance balance = power_balance(scene, solution);
    if (!(channel_sum(balance.emitted) > 0)) return {};
    return fmt::format(", {:.6g} lm emitted = {:.6g} absorbed + {:.6g} escaped ({:+.3f}%)", luminance(balance.emitted),
                       luminance(balance.absorbed), luminance(balance.escaped), 100 * balance.relative_difference());
}

void log_outcome(const Scene& scene, const Solution& solution) {
    if (solution.non_finite > 0)
        spdlog::warn("{} powers were not finite and were ignored: the result is not reliable", solution.non_finite);
    if (solution.iterations.empty()) {
        if (channel_sum(solution.emitted_power) > 0)
            spdlog::warn("the run ended before any light had arrived: all surfaces that do not emit are dark");
        return;
    }
    const IterationReport& last = solution.iterations.back();
    spdlog::info("{}: {} rays in {}, {} elements{}{}{}", solution.options.method.name,
                 magnitude(static_cast<double>(last.rays)), duration(last.seconds), last.elements,
                 std::isfinite(last.error_estimate) ? ", estimated relative error " + text_of_error(last) : "",
                 last.escaped_rays > 0
                     ? fmt::format(", {} of the rays left the scene",
                                   percent(static_cast<double>(last.escaped_rays) / static_cast<double>(last.rays)))
                     : "",
                 text_of_balance(scene, solution));
    if (!solution.options.views.empty() && !std::isfinite(last.error_estimate) && solution.iterations.size() > 2)
        spdlog::warn("no view shows a lit surface that reflects light: the error is not known");
    if (solution.options.method.refines && last.elements + std::size_t{4} > solution.options.refinement.max_elements)
        spdlog::warn("refinement ended at {} elements: for a finer mesh raise --max-elements or --memory",
                     last.elements);
}

/// Limits the elements to the available memory. @param memory  Requested limit [bytes], or 0.
SolveOptions within_limits(const Scene& scene, const RayCaster& ray_caster, SolveOptions options, std::size_t memory) {
    if (options.refinement.max_elements < scene.patches.size())
        throw InputError(fmt::format("--max-elements: {}, expected at least the {} patches of {}",
                                     options.refinement.max_elements, scene.patches.size(), scene.name));
    const std::size_t usable = usable_memory();
    const std::size_t bytes = memory > 0 ? std::min(memory, usable) : usable;
    const MemoryNeed need = memory_need(scene, ray_caster, options);
    require_memory(need.with(scene.patches.size()), scene.name);
    if (options.method.bytes_per_ray > 0) {
        constexpr std::size_t share = 2;  // the other half is for elements
        const auto most = static_cast<std::int64_t>(bytes / share / options.method.bytes_per_ray);
        if (options.limits.rays == std::numeric_limits<std::int64_t>::max()) options.limits.rays = most;
        if (options.limits.rays > most)
            throw InputError(fmt::format("--rays {}: {} keeps every ray; the memory suffices for at most {}",
                                         options.limits.rays, options.method.name, most));
    }
    options.refinement.max_elements = std::min(options.refinement.max_elements, elements_within(need, bytes, scene));
    return options;
}

}  // namespace

void warn_of_covered_emission(const Scene& scene, const RayCaster& ray_caster) {
    const CoveredEmission covered = covered_emission(scene, ray_caster);
    if (covered.wholly + covered.partly == 0) return;
    spdlog::warn("of the emitting patches {} lie wholly and {} partly under coincident faces, which take {:.6g} lm",
                 covered.wholly, covered.partly, luminance(covered.power));
}

Solution run_solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& asked_for, std::size_t memory,
                   Checkpoints checkpoints, const EarlyLight& early_light) {
    warn_of_covered_emission(scene, ray_caster);
    const SolveOptions options = within_limits(scene, ray_caster, asked_for, memory);
    const std::shared_ptr<void> unowned;  // both outlive the solver
    return run_to_end(Solver(std::shared_ptr<const Scene>(unowned, &scene), options,
                             std::shared_ptr<const RayCaster>(unowned, &ray_caster)),
                      std::move(checkpoints), early_light);
}

Solution run_to_end(Solver solver, Checkpoints checkpoints, const EarlyLight& early_light) {
    {
        ProgressBar bar;
        const auto show = [&](const Progress& progress) {
            const IterationReport& report = *progress.iteration;
            bar.show({progress.fraction, report.seconds, report.rays, report.error_estimate});
        };
        stop_on_signal();
        const Monitor monitor{show, &stop_flag()};
        Limits limits;
        if (!checkpoints.file.empty()) limits.time = checkpoints.every;
        SharedRun run(solver, checkpoints.file);
        bool uses_light = early_light.use != nullptr;
        AdvanceReport report;
        do {
            Limits next = limits;
            if (uses_light) next.time = std::min(next.time, std::max(early_light.after, report.seconds));
            report = run.advance(next, monitor);
            const bool goes_on = !report.is_finished && !report.is_stopped;
            if (uses_light && goes_on)
                if (const std::optional<Limits> plan = early_light.use(solver.solution())) run.set_plan(*plan);
            uses_light = uses_light && early_light.repeats;
            checkpoints.save(solver);
        } while (!report.is_finished && !report.is_stopped);
    }
    const std::shared_ptr<const Scene> scene = solver.shared_scene();
    const std::shared_ptr<const RayCaster> ray_caster = solver.shared_ray_caster();
    Solution solution = std::move(solver).take_solution();
    log_outcome(*scene, solution);
    warn_of_leaks(*scene, *ray_caster, solution);
    warn_of_one_way_light(*scene, *ray_caster, solution);
    return solution;
}

}  // namespace interflect::command
