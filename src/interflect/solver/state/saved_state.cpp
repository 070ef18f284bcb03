#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

namespace {

using ReportNumbers = std::array<double, 20>;
constexpr const char* reports_name = "reports";

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
            r.largest_payload,
            r.high_payload,
            r.discarded_hits};
}

/// @throws std::runtime_error for a negative or too large number.
template <class Integer>
Integer count_of(double number) {
    constexpr double max_exact = 0x1p53;
    StateArchive::require_range(
        number >= 0 && number <= max_exact && number <= static_cast<double>(std::numeric_limits<Integer>::max()),
        reports_name);
    return static_cast<Integer>(number);
}

IterationReport report_of(const ReportNumbers& n) {
    IterationReport report{.iteration = count_of<int>(n[0]),
                           .seconds = n[1],
                           .rays = count_of<std::int64_t>(n[2]),
                           .power_rays = count_of<std::int64_t>(n[3]),
                           .importance_rays = count_of<std::int64_t>(n[4]),
                           .escaped_rays = count_of<std::int64_t>(n[5]),
                           .elements = count_of<std::uint32_t>(n[6]),
                           .leaves = count_of<std::uint32_t>(n[7]),
                           .total_power = {n[8], n[9], n[10]},
                           .escaped_power = {n[11], n[12], n[13]},
                           .error_estimate = n[14],
                           .noise_estimate = n[15],
                           .discretisation_estimate = n[16],
                           .largest_payload = n[17],
                           .high_payload = n[18],
                           .discarded_hits = n[19]};
    const bool is_finite_sum = is_finite(report.total_power) && is_finite(report.escaped_power);
    // Estimates are infinite if they are unknown.
    const bool is_estimate =
        report.error_estimate >= 0 && report.noise_estimate >= 0 && report.discretisation_estimate >= 0;
    StateArchive::require_range(is_finite_sum && is_estimate && report.seconds >= 0 && std::isfinite(report.seconds),
                                reports_name);
    return report;
}

void archive_counts(StateArchive& archive, const std::string& name, Counts& counts) {
    std::vector<std::uint64_t> numbers;
    for (std::size_t i = 0; i < counts.size(); ++i) numbers.push_back(counts[i]);
    numbers = archive.by_value(name, std::move(numbers));
    if (!archive.reads()) return;
    counts = {};
    counts.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        StateArchive::require_range(numbers[i] < Counts::end, name);
        counts.add(i, numbers[i]);
    }
}

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("the state of the run: ") + what);
}

}  // namespace

void SolverState::archive(StateArchive& archive) {
    // Archive the reports, the mesh and the light
    std::vector<ReportNumbers> reports;
    for (const IterationReport& r : light.solution.iterations) reports.push_back(numbers_of(r));
    reports = archive.by_value(reports_name, std::move(reports));
    const std::vector<ElementIndex> parents = archive.by_value("subdivided", light.forest->subdivided());
    archive.amounts("seconds", work.earlier_seconds);
    archive("irradiance", light.solution.irradiance);
    archive_groups(archive, "groups", light.solution.groups);
    archive_groups(archive, "direct", light.solution.direct);
    archive.amounts("indirect_importance", light.solution.indirect_importance);
    archive("non_finite", light.solution.non_finite);
    light.history.archive(archive);
    sampling.view.archive(archive);
    light.noise.archive(archive);
    rays.schedule.archive(archive);
    archive("risk", light.risk_check);
    StateArchive::require_range(light.risk_check.is_finite(), "risk");
    sampling.payloads.archive(archive);

    // Archive the targets, and aim the restored emission at them
    archive("targets", inputs.targets);
    if (archive.reads() && !inputs.targets.empty()) {
        // Halves of the scene's box may exceed it by rounding.
        Imath::Box3f box = inputs.emission.scene_box();
        const V3f rounding(1e-5f * box.size().length());
        box.min -= rounding;
        box.max += rounding;
        const auto is_inside = [&](const Imath::Box3f& target) {
            return is_finite(target.min) && is_finite(target.max) && !target.isEmpty() && box.intersects(target.min) &&
                   box.intersects(target.max);
        };
        require(inputs.emission.part_count() > 0 && inputs.targets.size() <= max_targets &&
                    std::all_of(inputs.targets.begin(), inputs.targets.end(), is_inside),
                "expected targets within the scene");
        inputs.emission = Emission(*inputs.lit, inputs.targets);
    }

    // Archive the sampling of the rays, and their numbers
    archive_counts(archive, "points/used", sampling.streams.used);
    archive("points/used_by_parts", sampling.streams.used_by_parts);
    archive("part_importance", sampling.part_importance);
    for (const PartImportance& part : sampling.part_importance)
        StateArchive::require_range(
            part.found >= 0 && std::isfinite(part.found) && part.rays >= 0 && std::isfinite(part.rays),
            "part_importance");
    archive("points/allocations", sampling.streams.allocations);
    archive("power_rays", rays.power);
    archive("importance_rays", rays.importance);
    archive("escaped_rays", rays.escaped);
    archive("rays_of_other_views", rays.of_other_views);
    archive("rays_of_first_importance", rays.of_first_importance);
    archive("escaped_power", light.escaped_power);
    archive.amounts("escaped_power_rays", light.escaped_power_rays);
    if (!archive.reads()) return;

    // Restore the reports and the mesh, and check that all arrays are consistent with them
    light.solution.iterations.clear();
    for (const ReportNumbers& numbers : reports) light.solution.iterations.push_back(report_of(numbers));
    light.forest->rebuild(parents);
    const std::size_t elements = light.forest->size();
    require(light.solution.irradiance.size() == elements, "expected the irradiance of every element");
    require(light.solution.groups.size() == inputs.groups.size() &&
                (light.solution.direct.empty() ||
                 light.solution.direct.size() == std::max<std::size_t>(1, inputs.groups.size())),
            "expected the irradiance by every light group");
    for (const GroupLight* of_groups : {&light.solution.groups, &light.solution.direct})
        for (const std::vector<Rgb>& of_group : *of_groups)
            require(of_group.size() == elements, "expected the irradiance of every element by every light group");
    require(!light.options().method.is_stochastic ||
                (light.history.size() == elements && light.noise.elements() == elements),
            "expected the noise of every element");
    require(rays.of_other_views <= rays.schedule.averaged_rays() || light.options().experimental.warm_up > 0,
            "expected a part of the averaged rays for other views");
    require(sampling.streams.used.size() <= elements, "expected no more numbers of points than elements");
    require(sampling.streams.used_by_parts.size() <= inputs.emission.part_count() &&
                sampling.part_importance.size() == inputs.emission.part_count(),
            "expected the importance of every part of the luminaires");
    require(light.solution.indirect_importance.size() == (sampling.view.empty() ? 0 : elements),
            "expected the importance of every element");
    require(sampling.view.is_consistent(*light.forest), "expected points of views on patches of the scene");
    if (sampling.view.empty()) return;
    set_view_importance(light, sampling);
    require(std::all_of(light.solution.view_importance.begin(), light.solution.view_importance.end(),
                        [](float v) { return std::isfinite(v); }),
            "expected finite importance");
}

}  // namespace interflect::detail
