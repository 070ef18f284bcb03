#include "interflect/cluster/heartbeat.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <mutex>
#include <utility>

namespace interflect::detail {

namespace {

using namespace std::chrono_literals;

/// Interval between beats. mpirun ends the other processes one to two seconds after a death; a few beats must fit in,
/// so that the loss is reported first.
constexpr std::chrono::milliseconds beat = 250ms;
/// Silence after which a process counts as lost. mpirun needs two more seconds to end all processes; the sum must stay
/// below 10 s.
constexpr std::chrono::milliseconds max_silence = 7s;
/// Interval at the end of the job, when all processes wait for the last beats.
constexpr std::chrono::milliseconds last_beat = 5ms;

/// Message of one byte, because MPI sends short messages without waiting for the receiver.
enum class Beat : unsigned char { alive, last };

/// Receives the beats of the previous process.
class Listener {
  public:
    Listener(MPI_Comm ring, int previous) : ring_(ring), previous_(previous) { listen(); }

    /// Returns true after new beats since the last call.
    bool hears() {
        bool is_heard = false;
        while (!has_ended_) {
            int is_there = 0;
            MPI_Test(&request_, &is_there, MPI_STATUS_IGNORE);
            if (!is_there) break;
            is_heard = true;
            has_ended_ = received_ == Beat::last;
            if (!has_ended_) listen();
        }
        return is_heard;
    }
    bool has_ended() const { return has_ended_; }

  private:
    void listen() { MPI_Irecv(&received_, 1, MPI_BYTE, previous_, 0, ring_, &request_); }

    MPI_Comm ring_;
    int previous_;
    Beat received_ = Beat::alive;
    MPI_Request request_ = MPI_REQUEST_NULL;
    bool has_ended_ = false;
};

/// Sends beats to the next process, and skips beats while an earlier one is on its way.
class Sender {
  public:
    Sender(MPI_Comm ring, int next) : ring_(ring), next_(next) {}

    void send(Beat kind) {
        if (has_ended_ || !is_idle()) return;
        sent_ = kind;
        MPI_Isend(&sent_, 1, MPI_BYTE, next_, 0, ring_, &request_);
        has_ended_ = kind == Beat::last;
    }
    /// Returns whether the last beat was sent.
    bool has_ended() { return has_ended_ && is_idle(); }

  private:
    bool is_idle() {
        int is_sent = 0;
        MPI_Test(&request_, &is_sent, MPI_STATUS_IGNORE);
        return is_sent != 0;
    }

    MPI_Comm ring_;
    int next_;
    Beat sent_ = Beat::alive;
    MPI_Request request_ = MPI_REQUEST_NULL;
    bool has_ended_ = false;
};

}  // namespace

ProcessIdentity ProcessIdentity::own() {
    ProcessIdentity own;
    ::gethostname(own.host.data(), own.host.size() - 1);
    std::ifstream("/proc/sys/kernel/random/boot_id").read(own.kernel.data(), own.kernel.size());
    struct stat status {};
    if (::stat("/proc/self/ns/pid", &status) == 0) own.pid_namespace = status.st_ino;
    own.process = ::getpid();
    return own;
}

bool ProcessIdentity::sees_end_of(const ProcessIdentity& other) const {
    return pid_namespace != 0 && pid_namespace == other.pid_namespace && kernel == other.kernel &&
           ::kill(other.process, 0) != 0 && errno == ESRCH;
}

Heartbeat::Heartbeat(std::function<void(const std::string&)> on_loss)
    : own_(ProcessIdentity::own()), on_loss_(std::move(on_loss)) {
    MPI_Comm_dup(MPI_COMM_WORLD, &ring_);
    MPI_Comm_set_errhandler(ring_, MPI_ERRORS_RETURN);  // a failed beat counts as silence
    int rank = 0, count = 1;
    MPI_Comm_rank(ring_, &rank);
    MPI_Comm_size(ring_, &count);
    next_ = (rank + 1) % count;
    previous_ = (rank + count - 1) % count;
    MPI_Sendrecv(&own_, sizeof own_, MPI_BYTE, next_, 0, &watched_, sizeof watched_, MPI_BYTE, previous_, 0, ring_,
                 MPI_STATUS_IGNORE);
    thread_ = std::jthread([this](const std::stop_token& is_over) { watch(is_over); });
}

Heartbeat::~Heartbeat() {
    thread_.request_stop();
    thread_.join();
    MPI_Comm_free(&ring_);
}

void Heartbeat::watch(const std::stop_token& is_over) {
    Listener listener(ring_, previous_);
    Sender sender(ring_, next_);
    std::mutex mutex;
    std::condition_variable_any never;
    // Sum of the intervals, not time by the clock: if this process itself was stopped, the previous one is not silent.
    std::chrono::milliseconds silence{0};
    while (!listener.has_ended() || !sender.has_ended()) {
        const bool is_last = is_over.stop_requested();
        sender.send(is_last ? Beat::last : Beat::alive);
        const bool is_dead = own_.sees_end_of(watched_);
        if (listener.hears()) silence = {};
        if (!listener.has_ended() && (is_dead || silence >= max_silence))
            return on_loss_(fmt::format(
                "process {} on {} {}", previous_, watched_.host.data(),
                is_dead ? std::string("has ended unexpectedly: killed, crashed or out of memory")
                        : fmt::format("has not answered for {} s: it is stopped, or its machine or network is down",
                                      max_silence / 1s)));
        const std::chrono::milliseconds interval = is_last ? last_beat : beat;
        silence += interval;
        std::unique_lock lock(mutex);
        if (is_last)
            std::this_thread::sleep_for(interval);
        else
            never.wait_for(lock, is_over, interval, [] { return false; });
    }
}

}  // namespace interflect::detail
