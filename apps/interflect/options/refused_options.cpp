#include "apps/interflect/options/refused_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/values/parse.h"
#include "interflect/solution.h"

namespace interflect::command {

namespace {

using Names = std::span<const std::string_view>;

bool has(Names names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

constexpr std::array<std::string_view, 5> solving_groups = {solver_group, limits_group, refinement_group,
                                                            importance_group, experimental_group};

/// Returns the name that the user gave: "--no-mirrors" for the option "--mirrors,!--no-mirrors".
std::string given_name(const CLI::Option& option) {
    for (const std::string& negation : option.get_fnames())
        if (option.results() == CLI::results_t{option.get_flag_value(negation, "")}) return "--" + negation;
    return option.get_name();
}

std::vector<std::string_view> options_of_solving(std::initializer_list<std::string_view> others) {
    std::vector<std::string_view> names(solving_groups.begin(), solving_groups.end());
    names.insert(names.end(), others);
    return names;
}

}  // namespace

void refuse_options(const CLI::App& command, Names refused, const std::string& reason, Names accepted) {
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        const bool is_refused = has(refused, name) || has(refused, option->get_group());
        if (option->count() > 0 && is_refused && !has(accepted, name)) throw UsageError(given_name(*option), reason);
    }
}

void refuse_solver_options(const CLI::App& command) {
    constexpr std::array<std::string_view, 3> of_paths = {"--seed", "--until", "--contact-cuts"};
    refuse_options(command, options_of_solving({"--show"}), "--shading path and instant make no solution", of_paths);
}

void refuse_path_options(const CLI::App& command, const std::string& reason) {
    constexpr std::array<std::string_view, 1> of_paths = {path_group};
    refuse_options(command, of_paths, reason);
}

void refuse_scene_options(const CLI::App& command, const std::filesystem::path& scene, bool traces_paths) {
    if (!is_solution_file(scene)) return;
    constexpr std::array<std::string_view, 2> of_paths = {"--seed", "--until"};
    refuse_options(command,
                   options_of_solving({"MORE", "--curve-divisions", "--unit", "--up-axis", "--outside-files",
                                       "--max-patches", "--luminaire", daylight_group}),
                   fmt::format("it has no effect on {}, which is solved already: expected a scene", scene.string()),
                   traces_paths ? Names(of_paths) : Names());
}

}  // namespace interflect::command
