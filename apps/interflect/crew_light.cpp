#include "apps/interflect/crew_light.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "apps/interflect/commands.h"
#include "apps/interflect/crew.h"
#include "interflect/elements/forest.h"
#include "interflect/render/light_help.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Makes a solution without light. Its file contains the scene.
Solution dark_solution(const Scene& scene) {
    Solution dark;
    dark.options.method = default_method(false);  // files name one
    dark.forest = std::make_shared<ElementForest>(scene, scene.patches.size());
    const std::size_t elements = dark.forest->size();
    dark.irradiance.assign(elements, Rgb(0));
    for (std::vector<float>* values : {&dark.standard_error, &dark.discretisation_error, &dark.rays})
        values->assign(elements, 0);
    return dark;
}

void end_all(const std::exception& error, int exit_code) {
    spdlog::error("{}", error.what());
    abort_crew(exit_code);
}

}  // namespace

CrewLight::~CrewLight() { end_light_help(ranks_); }

void CrewLight::start() {
    if (ranks_) return;
    ranks_ = start_light_help([this](const std::filesystem::path& path) {
        write_solution(path, scene_, solution_ ? *solution_ : dark_solution(scene_));
    });
}

void CrewLight::share(Monitor monitor, const std::function<void(const Monitor&)>& work) try {
    start();
    monitor.ranks = ranks_;
    work(monitor);
} catch (const Stopped&) {
    throw;
} catch (const InputError& e) {
    if (ranks_) end_all(e, bad_input);
    throw;
} catch (const std::exception& e) {
    if (ranks_) end_all(e, failed);
    throw;
}

}  // namespace interflect::command
