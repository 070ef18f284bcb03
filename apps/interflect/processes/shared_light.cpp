#include "apps/interflect/processes/shared_light.h"

#include <memory>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/processes/shared_run.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/saved_run.h"
#include "interflect/render/shared_light.h"

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

}  // namespace

SharedLight::~SharedLight() { end_shared_light(ranks_); }

void SharedLight::start() {
    if (ranks_) return;
    ranks_ = start_shared_light(
        [this] { return solution_image(scene_, solution_ ? *solution_ : dark_solution(scene_), nullptr); });
}

void SharedLight::share(Monitor monitor, const std::function<void(const Monitor&)>& work) try {
    start();
    monitor.ranks = ranks_;
    work(monitor);
} catch (const Stopped&) {
    throw;
} catch (const InputError& e) {
    if (ranks_) end_ranks_after_fault(e, bad_input);
    throw;
} catch (const std::exception& e) {
    if (ranks_) end_ranks_after_fault(e, failed);
    throw;
}

}  // namespace interflect::command
