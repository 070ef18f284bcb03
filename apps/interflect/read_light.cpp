#include "apps/interflect/read_light.h"

#include <fmt/format.h>

#include "apps/interflect/long_work.h"
#include "apps/interflect/refused_options.h"

namespace interflect::command {

SolvedScene read_light_of(const std::filesystem::path& solution) {
    const LongWork work(fmt::format("reading {}", solution.string()));
    return read_solution(solution);
}

SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming, const CLI::App& command,
                                   bool traces_paths) {
    SolvedScene solved;
    if (!is_solution_file(scene.path)) {
        solved.scene = scene.load();
        return solved;
    }
    refuse_scene_options(command, scene.path, traces_paths);
    solved = read_light_of(scene.path);
    dimming.dim(solved);
    return solved;
}

}  // namespace interflect::command
