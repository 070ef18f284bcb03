#pragma once

#include <mpi.h>
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace interflect::detail {

/// Host and number of a process, for other processes.
struct ProcessIdentity {
    std::array<char, 64> host{};      ///< Name, ends with 0.
    std::array<char, 36> kernel{};    ///< Boot ID: equal for processes under the same kernel.
    std::uint64_t pid_namespace = 0;  ///< Inode of the namespace of process IDs.
    pid_t process = 0;

    static ProcessIdentity own();
    /// Returns true if `other` has ended. Always false for a process on another machine or in another container.
    bool sees_end_of(const ProcessIdentity& other) const;
};

/// A thread in each process that sends beats to the next process of a ring and watches the previous one. Exactly one
/// process follows each gap in the ring and reports it.
///
/// Detects SIGSTOP, a frozen machine and a broken network after 7 s, and the death of a process on the same machine
/// after 0.25 s. An endless loop in the solver remains undetected, because a step has no time limit.
class Heartbeat {
  public:
    /// Collective. At least two processes.
    /// @param on_loss  Called by the thread with a sentence about the lost process; must end the job.
    explicit Heartbeat(std::function<void(const std::string&)> on_loss);
    /// Collective: waits for the last beat of the previous process.
    ~Heartbeat();
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;

  private:
    void watch(const std::stop_token& is_over);

    MPI_Comm ring_ = MPI_COMM_NULL;
    int next_ = 0, previous_ = 0;
    ProcessIdentity own_, watched_;
    std::function<void(const std::string&)> on_loss_;
    std::jthread thread_;  // the last member, because it uses all others
};

}  // namespace interflect::detail
