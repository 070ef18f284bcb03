#include "apps/interflect/read_light.h"

#include "apps/interflect/refused_options.h"

namespace interflect::command {

SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming, const CLI::App& command,
                                   bool traces_paths) {
    SolvedScene solved;
    if (!is_solution_file(scene.path)) {
        dimming.require_solution(scene.path);
        solved.scene = scene.load();
        return solved;
    }
    refuse_scene_options(command, scene.path, traces_paths);
    solved = read_solution(scene.path);
    dimming.dim(solved);
    return solved;
}

}  // namespace interflect::command
