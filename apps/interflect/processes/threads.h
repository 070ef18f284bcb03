#pragma once

#include <tbb/global_control.h>

#include <optional>

namespace interflect::command {

/// Limits the number of concurrent threads during its lifetime. A limit of 0 has no effect.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads) {
        if (threads > 0)
            control_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    }

  private:
    std::optional<tbb::global_control> control_;
};

}  // namespace interflect::command
