#include "apps/interflect/read_light.h"

#include <fmt/format.h>

#include "apps/interflect/long_work.h"

namespace interflect::command {

SolvedScene read_light_of(const std::filesystem::path& solution) {
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
