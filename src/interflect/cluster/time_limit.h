#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace interflect::detail {

/// Ends this process with exit code 1 if this object exists for too long. Protects functions of MPI that wait for all
/// processes. Without memory for a thread there is no limit.
class TimeLimit {
  public:
    /// @param limit   Rounded up to 100 ms.
    /// @param report  Called before the end, by another thread.
    TimeLimit(std::chrono::milliseconds limit, std::function<void()> report);

  private:
    std::jthread thread_;
};

}  // namespace interflect::detail
