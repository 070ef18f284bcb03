/// Long work without the lock of the interpreter, with progress and Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

#include "interflect/core.h"

namespace interflect::python {

/// How an exception ends work.
enum class Ending {
    stopped,    ///< The work ends by its monitor, at a point that it chooses.
    cancelled,  ///< The work also ends in any parallel loop, so it must not have side effects.
};

/// Runs `work` on another thread, within at most `threads` threads (0: all), while this one calls progress(Progress)
/// and passes on Ctrl-C. An exception of either ends the work and is thrown when it has ended.
/// @param progress  A function, or None.
void run_long_work(const pybind11::object& progress, int threads, Ending ending,
                   const std::function<void(const Monitor&)>& work);

template <class Work>
auto long_work(const pybind11::object& progress, int threads, const Work& work, Ending ending = Ending::stopped) {
    std::optional<decltype(work(Monitor()))> result;
    run_long_work(progress, threads, ending, [&](const Monitor& monitor) { result.emplace(work(monitor)); });
    return std::move(*result);
}

/// The same for work without side effects, and without progress.
template <class Work>
auto pure_work(int threads, const Work& work) {
    return long_work(
        pybind11::none(), threads, [&](const Monitor&) { return work(); }, Ending::cancelled);
}

}  // namespace interflect::python
