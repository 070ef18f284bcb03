#pragma once

#include <mpi.h>
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace interflect::detail {

/// What one process needs to watch another.
struct ProcessIdentity {
    std::array<char, 64> host{};        ///< Name, ends with 0.
    std::array<char, 36> kernel{};      ///< Boot ID: equal for processes under the same kernel.
    std::uint64_t process_numbers = 0;  ///< Inode of the namespace of process IDs.
    pid_t process = 0;

    static ProcessIdentity own();
    /// Returns whether this process can see that `other` has ended, and it has.
    bool sees_end_of(const ProcessIdentity& other) const;
};

/// A thread in each process that sends signs of life to the next one, in a ring, and watches the previous one. The
/// process after a stopped or dead one notices, so each such gap in the ring is reported once.
///
/// It notices a process that is stopped (SIGSTOP, a frozen machine, a cut network) within `max_silence`, and one that
/// has ended on the same machine within `beat`. It does not notice a solver that computes for ever.
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
    std::jthread thread_;  // last: uses all others
};

}  // namespace interflect::detail
