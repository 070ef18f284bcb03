#include "apps/interflect/refused_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/interflect/parse.h"
#include "apps/interflect/run_path_tracer.h"
#include "apps/interflect/shared_options.h"
#include "interflect/error.h"

namespace interflect::command {

namespace {

bool is_given(const CLI::Option* option) { return option->count() > 0; }

template <std::size_t Count>
bool has(const std::array<std::string_view, Count>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 2> shared_with_path_tracing = {"--seed", "--until"};

bool is_of_solving(const CLI::Option& option) {
    constexpr std::array<std::string_view, 5> groups = {solver_group, limits_group, refinement_group, importance_group,
                                                        experimental_group};
    return has(groups, option.get_group());
}

}  // namespace

void refuse_solver_options(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        const bool is_for_paths = has(shared_with_path_tracing, name) || name == "--contact-cuts";
        if (is_given(option) && ((is_of_solving(*option) && !is_for_paths) || name == "--show"))
            throw UsageError(fmt::format("{}: --shading path makes no solution", name));
    }
}

void refuse_path_options(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options())
        if (option->get_group() == path_group && is_given(option))
            throw UsageError(fmt::format("{}: only --shading gather and path take it", option->get_name()));
}

void refuse_scene_options(const CLI::App& command, const std::filesystem::path& solution, bool traces_paths) {
    constexpr std::array<std::string_view, 6> of_reading = {"--curve-divisions", "--unit",        "--up-axis",
                                                            "--outside-files",   "--max-patches", "--luminaire"};
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (!is_given(option) ||
            !(is_of_solving(*option) || has(of_reading, name) || option->get_group() == daylight_group))
            continue;
        if (traces_paths && has(shared_with_path_tracing, name)) continue;
        throw InputError(solution, 0, fmt::format("it is solved already: {} has no effect, expected a scene", name));
    }
}

}  // namespace interflect::command
