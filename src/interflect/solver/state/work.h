#pragma once

#include <chrono>

#include "interflect/base/sums/common_stop.h"
#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/core.h"

namespace interflect::detail {

/// A call in progress, which alone may be shared with other ranks.
struct Work {
    Monitor monitor;
    CommonStop stop;  // after a first estimate, also by the time limit
    StopRequest::Clock::time_point start_of_this_call;
    double earlier_seconds = 0;
    Ranks::Traffic reported_traffic;

    void begin(const Monitor& m) {
        monitor = m;
        stop = CommonStop(m.stop, m.ranks);
        start_of_this_call = StopRequest::Clock::now();
        reported_traffic = m.ranks ? m.ranks->traffic() : Ranks::Traffic();
    }
    void end() {
        earlier_seconds = seconds();
        monitor = {};
        stop = {};
    }
    /// Time on the clock of rank 0 [s].
    double seconds_of_this_call() const {
        const std::chrono::duration<double> passed = StopRequest::Clock::now() - start_of_this_call;
        return of_first_rank(monitor.ranks, passed.count());
    }
    /// Includes earlier calls [s].
    double seconds() const { return earlier_seconds + seconds_of_this_call(); }
};

}  // namespace interflect::detail
