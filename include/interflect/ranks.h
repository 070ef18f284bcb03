/// @file
/// Processes that share a run, on one or several machines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace interflect {

/// Processes that solve one scene together. Each holds the scene and the whole state, and traces its part of the rays;
/// so all end with the same bits, as one process would. Functions that are not const are collective: all processes call
/// them in the same order, each from one thread.
class Ranks {
  public:
    using Bytes = std::vector<std::byte>;

    virtual ~Ranks() = default;
    virtual int rank() const = 0;   ///< Number of this process, from 0.
    virtual int count() const = 0;  ///< Number of processes, at least 1.

    /// Sends parts[r] to rank r. @return  Received bytes, by sender.
    virtual std::vector<Bytes> exchange(const std::vector<Bytes>& parts) = 0;
    /// Returns the bytes of all ranks. Their sizes may differ.
    virtual std::vector<Bytes> gather(std::span<const std::byte> bytes) = 0;
    /// Copies the bytes of rank 0 to all ranks. All ranks must pass equal sizes.
    virtual void broadcast(std::span<std::byte> bytes) = 0;
    /// Ends all processes at once, after a fault of one of them.
    [[noreturn]] virtual void abort(int exit_code) = 0;

    /// Data sent by the functions above, and their time.
    struct Traffic {
        std::int64_t bytes = 0;  ///< Sent to other ranks.
        double seconds = 0;      ///< Time, including that of waiting for other processes.
    };
    /// Traffic of this process so far.
    virtual Traffic traffic() const = 0;
};

/// Returns the rank that the launcher (mpirun, srun) gave this process, also before join_ranks(). Empty without a
/// launcher.
std::optional<int> launched_rank();

/// Receives a sentence about a lost process, without a full stop. Called by another thread; then all processes end. One
/// process reports each loss.
using FaultReport = std::function<void(const std::string& fault)>;

/// Joins the processes of mpirun. All end within 10 s (70 s during the start) after the death of a process, a SIGSTOP
/// or the loss of a machine.
/// @return  Null if this process is alone.
/// @throws std::runtime_error if it is not alone and Interflect was built without MPI, if MPI does not connect all
/// processes of the launcher, or if MPI does not support several threads.
std::shared_ptr<Ranks> join_ranks(const FaultReport& report);

}  // namespace interflect
