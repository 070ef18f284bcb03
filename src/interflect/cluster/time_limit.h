#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace interflect::detail {

/// Ends this process, with exit code 1, if this object lives too long. For operations of MPI that wait for all
/// processes: one that is stopped would make the others wait for ever. Without memory for a thread there is no limit.
class TimeLimit {
  public:
    /// @param report  Called before the end, by another thread.
    TimeLimit(std::chrono::milliseconds limit, std::function<void()> report);

  private:
    std::jthread thread_;
};

}  // namespace interflect::detail
