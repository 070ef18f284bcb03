#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace interflect::detail {

/// Number of threads on which the functions of parallel.h work.
inline int thread_count() {
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(static_cast<int>(allowed), tbb::this_task_arena::max_concurrency());
}

}  // namespace interflect::detail
