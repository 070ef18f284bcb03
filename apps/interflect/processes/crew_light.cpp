#include "apps/interflect/processes/crew_light.h"

#include <memory>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/processes/crew.h"
#include "interflect/exports/saved_run.h"
#include "interflect/render/light_help.h"

namespace interflect::command {

using namespace detail;

CrewLight::~CrewLight() { end_light_help(ranks_); }

void CrewLight::start() {
    if (ranks_) return;
    ranks_ = start_light_help(
        [this] { return solution_image(scene_, solution_ ? *solution_ : dark_solution(scene_), nullptr); });
}

void CrewLight::share(Monitor monitor, const std::function<void(const Monitor&)>& work) try {
    start();
    monitor.ranks = ranks_;
    work(monitor);
} catch (const Stopped&) {
    throw;
} catch (const InputError& e) {
    if (ranks_) end_crew_after_fault(e, bad_input);
    throw;
} catch (const std::exception& e) {
    if (ranks_) end_crew_after_fault(e, failed);
    throw;
}

}  // namespace interflect::command
