#include "apps/interflect/read_light.h"

#include "apps/interflect/refused_options.h"
#include "interflect/error.h"

namespace interflect::command {

SolvedScene read_scene_or_solution(const SceneOptions& scene, const DimmingOptions& dimming, const CLI::App& command,
                                   bool traces_paths) {
    SolvedScene solved;
    if (!is_solution_file(scene.path)) {
        if (!dimming.factors.empty())
            throw InputError(scene.path, 0,
                             "--dim needs the light of a solution: solve the scene with --light-groups first");
        solved.scene = scene.load();
        return solved;
    }
    solved = read_solution(scene.path);
    dimming.dim(solved);
    refuse_scene_options(command, scene.path, traces_paths);
    return solved;
}

}  // namespace interflect::command
