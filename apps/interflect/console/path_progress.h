#pragma once

#include <functional>

#include "apps/interflect/processes/crew_light.h"
#include "interflect/render.h"

namespace interflect::command {

/// Calls `work` with a monitor that shows a progress bar and obeys stop_flag(). @return  Duration [s].
double with_path_progress(const std::function<void(const Monitor&)>& work);
/// Shares the work with the crew, too.
double with_path_progress(CrewLight& crew_light, const std::function<void(const Monitor&)>& work);

}  // namespace interflect::command
