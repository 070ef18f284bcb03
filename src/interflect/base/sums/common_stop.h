#pragma once

#include <atomic>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/ranks.h"

namespace interflect::detail {

/// Stop request of rank 0, which all ranks obey. With several ranks, loops within a process run to their end.
class CommonStop {
  public:
    CommonStop() = default;
    CommonStop(const std::atomic<bool>* flag, Ranks* ranks) : requested_(flag), ranks_(ranks) {}

    void limit_time(StopRequest::Clock::time_point start, double seconds) { requested_.limit_time(start, seconds); }
    /// Returns the stop request for loops within this process. It is never due with several ranks.
    const StopRequest& within_process() const { return ranks_ ? never_ : requested_; }
    /// The following are collective.
    bool is_due() const { return of_first_rank(ranks_, requested_.is_due()); }
    bool is_asked_for() const { return of_first_rank(ranks_, requested_.is_asked_for()); }
    Ranks* ranks() const { return ranks_; }

  private:
    StopRequest requested_, never_;
    Ranks* ranks_ = nullptr;
};

}  // namespace interflect::detail
