#include "apps/interflect/options/light_group_options.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <string>

#include "interflect/core.h"
#include "interflect/solution.h"

namespace interflect::command {

void LightGroupOptions::add_to(CLI::App& app) {
    CLI::Option* const all =
        app.add_flag("--light-groups", by_name,
                     "Keep the light of each object with sources apart (of each emitting material where there are no "
                     "objects), for render --dim");
    add_each(app, "--group", groups, parse_light_group,
             "Keep the light of some sources apart: those whose object, material or light has such a name ('*' "
             "stands for anything); may be repeated")
        ->type_name("NAME=PATTERN")
        ->excludes(all);
}

void LightGroupOptions::check() const {
    Scene without_sources;
    without_sources.light_groups = groups;
    check_option("--group", [&] { source_groups(without_sources); });
}

void LightGroupOptions::set_groups(Scene& scene) const {
    scene.light_groups.insert(scene.light_groups.end(), groups.begin(), groups.end());
    if (by_name) scene.light_groups = groups_by_name(scene);
    if (scene.light_groups.empty()) return;
    require_sources_of_groups(scene);
    std::string names;
    for (const std::string& name : source_groups(scene).names) names += (names.empty() ? "" : ", ") + name;
    spdlog::info("light groups: {}", names);
}

void DimmingOptions::add_to(CLI::App& app) {
    add_each(app, "--dim", factors, parse_dimmed,
             "Scale the light of a group of a solution (see solve --light-groups); may be repeated")
        ->type_name("GROUP=FACTOR");
}

void DimmingOptions::dim(SolvedScene& solved) const {
    for (const auto& [group, factor] : factors) try {
            interflect::dim(solved.scene, solved.solution, group, factor);
        } catch (const InputError& e) {
            throw InputError(fmt::format("--dim {}={}: {}", group, factor, e.what()));
        }
}

void DimmingOptions::require_solution(const std::filesystem::path& scene) const {
    if (!factors.empty() && !is_solution_file(scene))
        throw UsageError("--dim",
                         fmt::format("{} is not solved, and only the light of a solution can be dimmed: expected "
                                     "a solution file (.h5) of solve --light-groups",
                                     scene.string()));
}

}  // namespace interflect::command
