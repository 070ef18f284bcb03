#include "interflect/solver/solver_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "interflect/base/address_space.h"
#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/light_targets.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/transport_steps.h"
#include "interflect/solver/view_importance.h"

namespace interflect::inline detail {

namespace {

/// A step may create more elements than it keeps (Oracle::max_elements). Reserves addresses for more than one or two
/// seconds of that, within half of the free address space.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    const std::size_t groups = std::min(scene.light_groups.size() + 1, most_light_groups);
    const std::size_t per_element =
        ElementForest::reserved_per_element + Arrivals::reserved_per_element(scene.light_groups.empty() ? 0 : groups);
    if (!options.method.refines) return scene.patches.size();
    if (!options.method.is_stochastic) return options.refinement.max_elements;  // never exceeded
    const std::size_t fitting = free_address_space() / 2 / per_element;
    return std::min(largest, options.refinement.max_elements +
                                 std::min(excess, fitting - std::min(fitting, options.refinement.max_elements)));
}

V3f centre_of(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    return geometry.point(forest.cell(element).centre(geometry.is_triangle()));
}

}  // namespace

SolverState::SolverState(const Scene& s, const RayCaster& caster, const SolveOptions& o)
    : scene(s),
      materials(scene, caster),
      emission(scene),
      ray_caster(caster),
      groups(source_groups(scene)),
      forest(std::make_shared<ElementForest>(scene, forest_capacity(scene, o))),
      view(o.views, o.seed),
      floor(scene, o),
      streams(o.experimental.points, o.seed),
      arrivals(forest->capacity(), groups.size()),
      schedule(o, scene.patches.size()),
      noise(scene.patches.size()) {
    solution.forest = forest;
    solution.options = o;
    solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
    solution.groups.assign(groups.size(), solution.irradiance);
    solution.group_names = groups.names;
    solution.dimming.assign(groups.size(), 1);
    history.assign(forest->size(), 0.0f);
    solution.emitted_power = radiated_power(*this);
    look(*this);
}

void SolverState::begin_work(const Monitor& monitor) {
    on_report = monitor.report;
    stop = StopRequest(monitor.stop);
    start = StopRequest::Clock::now();
}

IterationStart::IterationStart(const SolverState& state)
    : elements_(state.forest->size()),
      streams_(state.streams),
      targets_(state.targets),
      part_importance_(state.part_importance),
      indirect_importance_(state.solution.indirect_importance),
      power_rays_(state.power_rays),
      importance_rays_(state.importance_rays),
      escaped_rays_(state.escaped_rays),
      non_finite_(state.solution.non_finite),
      quanta_(state.quanta),
      reports_(state.solution.iterations.size()) {}

void IterationStart::restore(SolverState& state) const {
    Solution& solution = state.solution;
    if (state.forest->size() > elements_) {
        while (state.forest->size() > elements_) state.forest->drop_last_siblings();
        solution.irradiance.resize(elements_);
        for (std::vector<Rgb>& of_group : solution.groups) of_group.resize(elements_);
        state.history.resize(elements_);
        state.noise.shrink(elements_);
        state.view.shrink(elements_);
        state.materials = Materials(*state.lit, state.ray_caster);
        state.materials.grow(*state.forest);
        if (!state.view.empty())
            solution.view_importance =
                state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
    }
    if (state.targets != targets_) set_targets(state, targets_);
    state.part_importance = part_importance_;
    state.streams = streams_;
    solution.indirect_importance = indirect_importance_;
    state.power_rays = power_rays_;
    state.importance_rays = importance_rays_;
    state.escaped_rays = escaped_rays_;
    solution.non_finite = non_finite_;
    state.quanta = quanta_;
    solution.iterations.resize(reports_);
}

void set_sources(SolverState& state, const Scene& lit) {
    state.lit = &lit;
    state.materials = Materials(lit, state.ray_caster);
    state.materials.grow(*state.forest);
    state.emission = Emission(lit, state.targets);
    state.solution.emitted_power =
        radiated_power(*state.forest, Radiosity(state.materials, std::vector<Rgb>(state.forest->size(), Rgb(0))));
    state.solution.emitted_power += state.emission.total_power();
}

void set_targets(SolverState& state, std::vector<Imath::Box3f> targets) {
    state.targets = std::move(targets);
    state.emission = Emission(*state.lit, state.targets);
    state.part_importance.assign(state.emission.part_count(), {});
    std::vector<std::uint64_t>& used = state.streams.used_by_parts;
    used.resize(std::min(used.size(), state.emission.part_count()));
}

void look(SolverState& state) {
    if (state.targets.empty())
        state.part_importance.assign(state.emission.part_count(), {});
    else
        set_targets(state, {});
    state.view = ViewImportance(state.options.views, state.options.seed);
    state.floor = ElementFloor(state.scene, state.options);
    state.view.trace_view_rays(*state.forest, state.ray_caster, Panes(state.scene, state.ray_caster),
                               state.options.importance.camera_rays);
    state.solution.view_importance.clear();
    state.solution.indirect_importance.clear();
    if (state.view.empty()) return;
    if (state.neighbourhoods.empty()) state.neighbourhoods = Neighbourhoods(*state.forest);
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
    state.solution.indirect_importance.assign(state.forest->size(), 0.0f);
}

namespace {

using ReportNumbers = std::array<double, 19>;

ReportNumbers numbers_of(const IterationReport& r) {
    return {static_cast<double>(r.iteration),
            r.seconds,
            static_cast<double>(r.rays),
            static_cast<double>(r.power_rays),
            static_cast<double>(r.importance_rays),
            static_cast<double>(r.escaped_rays),
            static_cast<double>(r.elements),
            static_cast<double>(r.leaves),
            r.total_power.x,
            r.total_power.y,
            r.total_power.z,
            r.escaped_power.x,
            r.escaped_power.y,
            r.escaped_power.z,
            r.error_estimate,
            r.noise_estimate,
            r.discretisation_estimate,
            r.largest_quantum,
            r.high_quantum};
}

IterationReport report_of(const ReportNumbers& n) {
    return {.iteration = static_cast<int>(n[0]),
            .seconds = n[1],
            .rays = static_cast<std::int64_t>(n[2]),
            .power_rays = static_cast<std::int64_t>(n[3]),
            .importance_rays = static_cast<std::int64_t>(n[4]),
            .escaped_rays = static_cast<std::int64_t>(n[5]),
            .elements = static_cast<std::uint32_t>(n[6]),
            .leaves = static_cast<std::uint32_t>(n[7]),
            .total_power = {n[8], n[9], n[10]},
            .escaped_power = {n[11], n[12], n[13]},
            .error_estimate = n[14],
            .noise_estimate = n[15],
            .discretisation_estimate = n[16],
            .largest_quantum = n[17],
            .high_quantum = n[18]};
}

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("the state of the run: ") + what);
}

}  // namespace

void SolverState::archive(StateArchive& archive) {
    std::vector<ReportNumbers> reports;
    for (const IterationReport& r : solution.iterations) reports.push_back(numbers_of(r));
    reports = archive.by_value("reports", std::move(reports));
    const std::vector<std::uint32_t> parents = archive.by_value("subdivided", forest->subdivided());
    archive("seconds", earlier_seconds);
    archive("irradiance", solution.irradiance);
    for (std::size_t g = 0; g < groups.size(); ++g) archive("groups/" + std::to_string(g), solution.groups[g]);
    archive("indirect_importance", solution.indirect_importance);
    archive("non_finite", solution.non_finite);
    archive("history", history);
    view.archive(archive);
    noise.archive(archive);
    schedule.archive(archive);
    archive("risk", risk_check);
    quanta.archive(archive);
    archive("targets", targets);
    if (archive.reads() && !targets.empty()) {
        const auto is_inside = [&](const Imath::Box3f& target) {
            const Imath::Box3f& box = emission.scene_box();
            return !target.isEmpty() && box.intersects(target.min) && box.intersects(target.max);
        };
        require(emission.part_count() > 0 && targets.size() <= most_targets &&
                    std::all_of(targets.begin(), targets.end(), is_inside),
                "expected targets within the scene");
        emission = Emission(*lit, targets);
    }
    archive("points/used", streams.used);
    archive("points/used_by_parts", streams.used_by_parts);
    archive("part_importance", part_importance);
    archive("points/allocations", streams.allocations);
    archive("power_rays", power_rays);
    archive("importance_rays", importance_rays);
    archive("escaped_rays", escaped_rays);
    archive("rays_of_other_views", rays_of_other_views);
    archive("escaped_power", escaped_power);
    archive("escaped_power_rays", escaped_power_rays);
    if (!archive.reads()) return;
    solution.iterations.clear();
    for (const ReportNumbers& numbers : reports) solution.iterations.push_back(report_of(numbers));
    forest->rebuild(parents);
    const std::size_t elements = forest->size();
    require(solution.irradiance.size() == elements, "expected the irradiance of every element");
    for (const std::vector<Rgb>& of_group : solution.groups)
        require(of_group.size() == elements, "expected the irradiance of every element by every light group");
    require(!options.method.is_stochastic || (history.size() == elements && noise.elements() == elements),
            "expected the noise of every element");
    require(streams.used.size() <= elements, "expected points of elements that there are");
    require(streams.used_by_parts.size() <= emission.part_count() && part_importance.size() == emission.part_count(),
            "expected the importance of every part of the luminaires");
    require(solution.indirect_importance.size() == (view.empty() ? 0 : elements),
            "expected the importance of every element");
    require(view.fits(*forest), "expected points of views on patches of the scene");
    if (!view.empty()) solution.view_importance = view.per_area(*forest, options.experimental.importance_at_patches);
}

Received run_step(SolverState& state, TransportStep step) {
    const std::uint32_t before = state.forest->size();
    Received received = transport(state.materials, *state.forest, state.ray_caster, std::move(step), state.streams,
                                  state.arrivals, state.stop);
    state.escaped_rays += received.escaped_rays;
    for (std::size_t i = 0; i < received.part_importance.size(); ++i) {
        state.part_importance[i].found += received.part_importance[i].found;
        state.part_importance[i].rays += received.part_importance[i].rays;
    }
    if (state.forest->size() > before) grow_with_forest(state, before);
    return received;
}

GroupRadiosity group_radiosity(const SolverState& state, const GroupLight& irradiance, bool emits) {
    if (state.groups.empty()) return {};
    return {&state.groups, &irradiance, &state.solution.dimming, emits};
}

RgbD radiated_power(const SolverState& state) {
    return radiated_power(*state.forest, Radiosity(state.materials, state.solution.irradiance)) +
           state.emission.total_power();
}

float min_area(const SolverState& state, std::uint32_t element) {
    const std::uint32_t patch = state.forest->patch(element);
    const bool is_seen = !state.view.empty() && state.solution.view_importance[patch] > 0;
    return state.floor.min_area(centre_of(*state.forest, element), state.forest->geometry(patch).normal(), is_seen);
}

float pixel_area(const SolverState& state, std::uint32_t element) {
    const V3f normal = state.forest->geometry(state.forest->patch(element)).normal();
    return state.floor.pixel_area(centre_of(*state.forest, element), normal);
}

void grow_with_forest(SolverState& state, std::uint32_t first) {
    inherit(*state.forest, first, state.solution.irradiance);
    inherit(*state.forest, first, state.solution.groups);
    state.noise.grow(*state.forest, first);
    state.materials.grow(*state.forest);
    inherit(*state.forest, first, state.history);
    if (state.view.empty()) return;
    inherit(*state.forest, first, state.solution.indirect_importance);
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
}

void refine_view_importance(SolverState& state) {
    constexpr std::int64_t rays_per_camera_ray = 64;
    if (state.view.empty()) return;
    const std::int64_t wanted =
        std::min<std::int64_t>(state.schedule.averaged_rays() / rays_per_camera_ray, most_camera_rays);
    if (wanted < 2 * state.view.rays()) return;
    state.view.trace_view_rays(*state.forest, state.ray_caster, Panes(state.scene, state.ray_caster),
                               static_cast<int>((wanted - state.view.rays()) / state.view.views()));
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
}

void report(SolverState& state, int iteration, const RgbD& escaped_power) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = state.seconds();
    r.rays = state.schedule.rays();
    r.power_rays = state.power_rays;
    r.importance_rays = state.importance_rays;
    r.escaped_rays = state.escaped_rays;
    r.elements = state.forest->size();
    r.leaves = state.forest->patch_count() + (r.elements - state.forest->patch_count()) / 4 * 3;
    r.total_power = radiated_power(state);
    r.escaped_power = escaped_power;
    const SolutionError error = solution_error(state);
    r.error_estimate = error.total();
    r.noise_estimate = error.noise;
    r.discretisation_estimate = error.discretisation;
    constexpr double share_with_more = 0.001;
    r.largest_quantum = state.quanta.largest_over_mean();
    r.high_quantum = state.quanta.quantile_over_mean(share_with_more);
    state.solution.iterations.push_back(r);
    if (state.on_report) state.on_report(r);
}

}  // namespace interflect::inline detail
