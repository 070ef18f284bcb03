#pragma once

#include <functional>

#include "apps/interflect/processes/shared_light.h"
#include "interflect/core.h"

namespace interflect::command {

/// Calls `work` with a monitor that shows a progress bar and obeys stop_flag(). @return  Duration [s].
double with_path_progress(const std::function<void(const Monitor&)>& work);
/// Shares the work with the other ranks, too.
double with_path_progress(SharedLight& shared_light, const std::function<void(const Monitor&)>& work);

}  // namespace interflect::command
