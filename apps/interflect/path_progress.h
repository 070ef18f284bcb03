#pragma once

#include <functional>

#include "interflect/path_tracer.h"

namespace interflect::command {

/// Calls `work`, whose rays a progress bar shows and the stop_flag() ends early.
/// @return How long it took [s].
double with_path_progress(const std::function<void(const PathMonitor&)>& work);

}  // namespace interflect::command
