#include "apps/interflect/solving/read_light.h"

#include <fmt/format.h>

#include <system_error>

#include "apps/interflect/processes/long_work.h"

namespace interflect::command {

SolvedScene read_light_of(const std::filesystem::path& solution) {
    std::error_code unknown;
    if (std::filesystem::is_regular_file(solution, unknown) && !is_solution_file(solution))
        throw InputError(solution, 0, "not a solution file: expected a file from `interflect solve` (.h5)");
    const LongWork work(fmt::format("reading {}", solution.string()));
    return read_solution(solution);
}

SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming) {
    SolvedScene solved;
    if (!is_solution_file(scene.path)) {
        solved.scene = scene.load();
        return solved;
    }
    solved = read_light_of(scene.path);
    dimming.dim(solved);
    return solved;
}

}  // namespace interflect::command
