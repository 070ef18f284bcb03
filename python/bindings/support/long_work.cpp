#include "long_work.h"

#include <pybind11/gil.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <mutex>
#include <string>
#include <utility>

namespace interflect::python {

namespace py = pybind11;

namespace {

/// Pause between checks for signals and progress: too short to be noticed, but long enough to cost little.
constexpr std::chrono::milliseconds between_checks{20};

/// Progress of the working thread, for the thread of the interpreter.
class LatestProgress {
  public:
    void set(const Progress& progress) {
        const std::scoped_lock lock(mutex_);
        latest_ = progress;
        latest_->iteration = nullptr;  // it is valid only during the call
    }
    std::optional<Progress> take() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(latest_, std::nullopt);
    }

  private:
    std::mutex mutex_;
    std::optional<Progress> latest_;
};

}  // namespace

void run_long_work(const py::object& progress, int threads, Ending ending,
                   const std::function<void(const Monitor&)>& work) {
    if (threads < 0)
        throw InputError("threads: expected 0 (all of the machine) or more, found " + std::to_string(threads));
    std::atomic<bool> stop{false};
    LatestProgress latest;
    const Monitor monitor{[&](const Progress& now) { latest.set(now); }, &stop};
    std::exception_ptr interruption;
    tbb::task_group_context loops;  // context of the work's parallel loops
    {
        const py::gil_scoped_release released;
        std::future<void> done = std::async(std::launch::async, [&] {
            const int most = tbb::info::default_concurrency();
            tbb::task_arena arena(threads > 0 ? std::min(threads, most) : most);
            arena.execute([&] { tbb::task_group(loops).run_and_wait([&] { work(monitor); }); });
        });
        while (done.wait_for(between_checks) != std::future_status::ready) {
            if (interruption) continue;
            const py::gil_scoped_acquire acquired;
            try {
                if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                if (const std::optional<Progress> now = latest.take(); now && !progress.is_none()) progress(*now);
            } catch (...) {
                interruption = std::current_exception();
                stop = true;
                if (ending == Ending::cancelled) loops.cancel_group_execution();
            }
        }
        if (!interruption) done.get();
    }
    if (interruption) std::rethrow_exception(interruption);
    if (const std::optional<Progress> last = latest.take(); last && !progress.is_none()) progress(*last);
}

}  // namespace interflect::python
