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

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("the state of the run: ") + what);
}

}  // namespace

void SolverState::archive(StateArchive& archive) {
    std::vector<ReportNumbers> reports;
    for (const IterationReport& r : solution.iterations) reports.push_back(numbers_of(r));
    reports = archive.by_value(reports_name, std::move(reports));
    const std::vector<std::uint32_t> parents = archive.by_value("subdivided", forest->subdivided());
    archive.amounts("seconds", earlier_seconds);
    archive("irradiance", solution.irradiance);
    archive_groups(archive, "groups", solution.groups);
    archive_groups(archive, "direct", solution.direct);
    archive.amounts("indirect_importance", solution.indirect_importance);
    archive("non_finite", solution.non_finite);
    archive.amounts("history", history);
    view.archive(archive);
    noise.archive(archive);
    schedule.archive(archive);
    archive("risk", risk_check);
    StateArchive::require_range(risk_check.is_finite(), "risk");
    payloads.archive(archive);
    archive("targets", targets);
    if (archive.reads() && !targets.empty()) {
        // Halves of the scene's box may exceed it by rounding.
        Imath::Box3f box = emission.scene_box();
        const V3f rounding(1e-5f * box.size().length());
        box.min -= rounding;
        box.max += rounding;
        const auto is_inside = [&](const Imath::Box3f& target) {
            return is_finite(target.min) && is_finite(target.max) && !target.isEmpty() && box.intersects(target.min) &&
                   box.intersects(target.max);
        };
        require(emission.part_count() > 0 && targets.size() <= max_targets &&
                    std::all_of(targets.begin(), targets.end(), is_inside),
                "expected targets within the scene");
        emission = Emission(*lit, targets);
    }
    archive("points/used", streams.used);
    archive("points/used_by_parts", streams.used_by_parts);
    archive("part_importance", part_importance);
    for (const PartImportance& part : part_importance)
        StateArchive::require_range(
            part.found >= 0 && std::isfinite(part.found) && part.rays >= 0 && std::isfinite(part.rays),
            "part_importance");
    archive("points/allocations", streams.allocations);
    archive("power_rays", power_rays);
    archive("importance_rays", importance_rays);
    archive("escaped_rays", escaped_rays);
    archive("rays_of_other_views", rays_of_other_views);
    archive("rays_of_first_importance", rays_of_first_importance);
    archive("escaped_power", escaped_power);
    archive.amounts("escaped_power_rays", escaped_power_rays);
    if (!archive.reads()) return;
    solution.iterations.clear();
    for (const ReportNumbers& numbers : reports) solution.iterations.push_back(report_of(numbers));
    forest->rebuild(parents);
    const std::size_t elements = forest->size();
    require(solution.irradiance.size() == elements, "expected the irradiance of every element");
    require(solution.groups.size() == groups.size() &&
                (solution.direct.empty() || solution.direct.size() == std::max<std::size_t>(1, groups.size())),
            "expected the irradiance by every light group");
    for (const GroupLight* light : {&solution.groups, &solution.direct})
        for (const std::vector<Rgb>& of_group : *light)
            require(of_group.size() == elements, "expected the irradiance of every element by every light group");
    require(!options.method.is_stochastic || (history.size() == elements && noise.elements() == elements),
            "expected the noise of every element");
    require(rays_of_other_views <= schedule.averaged_rays() || options.experimental.warm_up > 0,
            "expected a part of the averaged rays for other views");
    require(streams.used.size() <= elements, "expected points of elements that there are");
    require(streams.used_by_parts.size() <= emission.part_count() && part_importance.size() == emission.part_count(),
            "expected the importance of every part of the luminaires");
    require(solution.indirect_importance.size() == (view.empty() ? 0 : elements),
            "expected the importance of every element");
    require(view.fits(*forest), "expected points of views on patches of the scene");
    if (view.empty()) return;
    solution.view_importance = view.per_area(*forest, options.experimental.importance_at_patches);
    require(std::all_of(solution.view_importance.begin(), solution.view_importance.end(),
                        [](float v) { return std::isfinite(v); }),
            "expected finite importance");
}

}  // namespace interflect::detail
