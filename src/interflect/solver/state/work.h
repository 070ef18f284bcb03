#pragma once

#include <chrono>

#include "interflect/base/sums/common_stop.h"
#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/core.h"

namespace interflect::detail {

/// The call of Solver in progress. Monitor, stop request and ranks are set during a call only.
struct Work {
    Monitor monitor;
    CommonStop stop;  // after a first estimate, the time limit stops the call as well
    StopRequest::Clock::time_point start_of_this_call;
    double earlier_seconds = 0;  // time of earlier calls [s]
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
    /// Returns the time since the start of this call, on the clock of rank 0 [s].
    double seconds_of_this_call() const {
        const std::chrono::duration<double> passed = StopRequest::Clock::now() - start_of_this_call;
        return of_first_rank(monitor.ranks, passed.count());
    }
    /// Returns the time of all calls [s].
    double seconds() const { return earlier_seconds + seconds_of_this_call(); }
};

}  // namespace interflect::detail
