#include "apps/interflect/light_group_options.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <utility>

#include "interflect/dimming.h"
#include "interflect/error.h"

namespace interflect::command {

namespace {

/// "name=value" at its last '='. @throws InputError
std::pair<std::string, std::string> name_and_value(const char* option, const std::string& text, const char* expected) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw InputError(fmt::format("{} '{}': expected {}", option, text, expected));
    return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

void LightGroupOptions::add_to(CLI::App& app) {
    CLI::Option* const all =
        app.add_flag("--light-groups", by_name,
                     "Keep the light of each object with sources apart (of each emitting material where there are no "
                     "objects), for render --dim");
    app.add_option("--group", groups,
                   "Keep the light of some sources apart: those whose object, material or light has such a name ('*' "
                   "stands for anything); may be repeated")
        ->type_name("NAME=PATTERN")
        ->allow_extra_args(false)
        ->excludes(all);
}

void LightGroupOptions::set_groups(Scene& scene) const {
    for (const std::string& text : groups) {
        auto [name, pattern] = name_and_value("--group", text, "NAME=PATTERN, as in 'desk=lamps.desk*'");
        scene.light_groups.push_back({std::move(name), std::move(pattern)});
    }
    if (by_name) scene.light_groups = groups_by_name(scene);
    if (scene.light_groups.empty()) return;
    require_sources_of_groups(scene);
    std::string names;
    for (const std::string& name : source_groups(scene).names) names += (names.empty() ? "" : ", ") + name;
    spdlog::info("light groups: {}", names);
}

void DimmingOptions::add_to(CLI::App& app) {
    app.add_option("--dim", factors,
                   "Scale the light of a group of a solution (see solve --light-groups); may be repeated")
        ->type_name("GROUP=FACTOR")
        ->allow_extra_args(false);
}

void DimmingOptions::dim(SolvedScene& solved) const {
    for (const std::string& text : factors) {
        const auto [name, value] = name_and_value("--dim", text, "GROUP=FACTOR, as in 'desk=0.3'");
        float factor = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), factor);
        if (error != std::errc() || end != value.data() + value.size())
            throw InputError(fmt::format("--dim '{}': '{}' is not a number", text, value));
        interflect::dim(solved.scene, solved.solution, name, factor);
    }
}

}  // namespace interflect::command
