#include "interflect/cluster/time_limit.h"

#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <utility>

namespace interflect::detail {

namespace {

constexpr std::chrono::milliseconds interval{100};

}  // namespace

TimeLimit::TimeLimit(std::chrono::milliseconds limit, std::function<void()> report) {
    const auto wait = [limit, report = std::move(report)](const std::stop_token& is_over) {
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        // Counts intervals, because time in which this process itself was stopped must not count.
        for (auto left = limit; left.count() > 0; left -= interval) {
            never.wait_for(lock, is_over, interval, [] { return false; });
            if (is_over.stop_requested()) return;
        }
        report();
        std::_Exit(EXIT_FAILURE);
    };
    try {
        thread_ = std::jthread(wait);
    } catch (const std::system_error&) {  // too little memory: no limit
    }
}

}  // namespace interflect::detail
