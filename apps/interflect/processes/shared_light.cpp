#include "apps/interflect/processes/shared_light.h"

#include <memory>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/processes/shared_run.h"
#include "interflect/exports/saved_run.h"
#include "interflect/render/shared_light.h"

namespace interflect::command {

using namespace detail;

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
