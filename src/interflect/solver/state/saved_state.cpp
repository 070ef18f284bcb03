#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "interflect/base/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

namespace {

using ReportNumbers = std::array<double, 20>;

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
            .largest_payload = n[17],
            .high_payload = n[18],
            .discarded_hits = n[19]};
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
    archive_groups(archive, "groups", solution.groups);
    archive_groups(archive, "direct", solution.direct);
    archive("indirect_importance", solution.indirect_importance);
    archive("non_finite", solution.non_finite);
    archive("history", history);
    view.archive(archive);
    noise.archive(archive);
    schedule.archive(archive);
    archive("risk", risk_check);
    payloads.archive(archive);
    archive("targets", targets);
    if (archive.reads() && !targets.empty()) {
        const auto is_inside = [&](const Imath::Box3f& target) {
            const Imath::Box3f& box = emission.scene_box();
            return !target.isEmpty() && box.intersects(target.min) && box.intersects(target.max);
        };
        require(emission.part_count() > 0 && targets.size() <= max_targets &&
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
    archive("rays_of_first_importance", rays_of_first_importance);
    archive("escaped_power", escaped_power);
    archive("escaped_power_rays", escaped_power_rays);
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
    require(streams.used.size() <= elements, "expected points of elements that there are");
    require(streams.used_by_parts.size() <= emission.part_count() && part_importance.size() == emission.part_count(),
            "expected the importance of every part of the luminaires");
    require(solution.indirect_importance.size() == (view.empty() ? 0 : elements),
            "expected the importance of every element");
    require(view.fits(*forest), "expected points of views on patches of the scene");
    if (!view.empty()) solution.view_importance = view.per_area(*forest, options.experimental.importance_at_patches);
}

}  // namespace interflect::detail
