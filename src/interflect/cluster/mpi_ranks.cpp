#include <mpi.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <thread>

#include "interflect/cluster/heartbeat.h"
#include "interflect/cluster/launcher.h"
#include "interflect/cluster/time_limit.h"
#include "interflect/ranks.h"

namespace interflect {

using namespace detail;

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Time for all processes to start. Clusters load the program from one server for all machines, so starts differ by
/// tens of seconds.
constexpr std::chrono::seconds start_limit = 60s;
/// Time for MPI_Finalize(), before which all processes have exchanged their last beats. If process 0 is stopped, all
/// end after 9.5 s: see common_limit().
constexpr std::chrono::seconds finish_limit = 5s;
/// Time for MPI_Abort() to reach mpirun, which may be stopped.
constexpr std::chrono::seconds abort_limit = 2s;

/// Limits the time that all processes wait for each other. The lowest rank that is not stopped reports first. mpirun
/// then ends the others within two seconds, before they report.
TimeLimit common_limit(int rank, std::chrono::milliseconds limit, const FaultReport& report, const char* fault) {
    constexpr std::chrono::milliseconds head_start = 2500ms;
    return {limit + rank * head_start, [=] { report(fault); }};
}

/// @throws std::runtime_error if an MPI function failed.
void require(int code) {
    if (code == MPI_SUCCESS) return;
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    throw std::runtime_error(fmt::format("the connection of the processes failed: {}", text.data()));
}

/// MPI counts in int, so messages are counted in blocks: 128 GiB at most.
constexpr std::size_t block_bytes = 64;

int blocks_of(std::size_t bytes) {
    const std::size_t blocks = (bytes + block_bytes - 1) / block_bytes;
    if (blocks > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw std::runtime_error("a process has more than 128 GiB to send at once: use fewer elements");
    return static_cast<int>(blocks);
}

/// Consecutive parts of a buffer, each in whole blocks.
struct Layout {
    std::vector<std::int64_t> sizes;   ///< [bytes]
    std::vector<int> blocks, offsets;  ///< Size and offset of each part [blocks].
    std::size_t bytes = 0;

    explicit Layout(std::vector<std::int64_t> s) : sizes(std::move(s)) {
        for (const std::int64_t size : sizes) {
            offsets.push_back(blocks_of(bytes));
            blocks.push_back(blocks_of(static_cast<std::size_t>(size)));
            bytes += static_cast<std::size_t>(blocks.back()) * block_bytes;
        }
        blocks_of(bytes);
    }
    std::byte* part_in(Ranks::Bytes& all, std::size_t part) const {
        return all.data() + static_cast<std::size_t>(offsets[part]) * block_bytes;
    }
    std::vector<Ranks::Bytes> parts_of(Ranks::Bytes& all) const {
        std::vector<Ranks::Bytes> parts;
        for (std::size_t r = 0; r < sizes.size(); ++r) parts.emplace_back(part_in(all, r), part_in(all, r) + sizes[r]);
        return parts;
    }
};

class MpiRanks : public Ranks {
  public:
    explicit MpiRanks(FaultReport report) : report_(std::move(report)) {
        MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
        require(MPI_Type_contiguous(static_cast<int>(block_bytes), MPI_BYTE, &block_));
        require(MPI_Type_commit(&block_));
    }
    ~MpiRanks() override {
        heartbeat_.reset();
        MPI_Type_free(&block_);
        const TimeLimit limit = common_limit(rank_, finish_limit, report_, "a process was stopped at its end");
        MPI_Finalize();
    }

    /// Ends all processes if this one cannot start a thread.
    void start_heartbeat() try {
        if (count_ == 1) return;
        heartbeat_.emplace([this](const std::string& fault) {
            report_(fault);
            abort(EXIT_FAILURE);
        });
    } catch (const std::exception& e) {
        report_(fmt::format("process {} cannot watch another: {}", rank_, e.what()));
        abort(EXIT_FAILURE);
    }

    int rank() const override { return rank_; }
    int count() const override { return count_; }

    std::vector<Bytes> exchange(const std::vector<Bytes>& parts) override {
        const Stopwatch stopwatch(traffic_);
        std::vector<std::int64_t> sizes, sizes_here(parts.size());
        for (const Bytes& part : parts) sizes.push_back(static_cast<std::int64_t>(part.size()));
        wait_for_all();
        require(MPI_Alltoall(sizes.data(), 1, MPI_INT64_T, sizes_here.data(), 1, MPI_INT64_T, MPI_COMM_WORLD));
        const Layout out(sizes), in(sizes_here);
        Bytes sent(out.bytes), received(in.bytes);
        for (std::size_t r = 0; r < parts.size(); ++r) std::ranges::copy(parts[r], out.part_in(sent, r));
        require(MPI_Alltoallv(sent.data(), out.blocks.data(), out.offsets.data(), block_, received.data(),
                              in.blocks.data(), in.offsets.data(), block_, MPI_COMM_WORLD));
        for (int r = 0; r < count_; ++r)
            if (r != rank_) traffic_.bytes += sizes[static_cast<std::size_t>(r)];
        return in.parts_of(received);
    }

    std::vector<Bytes> gather(std::span<const std::byte> bytes) override {
        const Stopwatch stopwatch(traffic_);
        const auto size = static_cast<std::int64_t>(bytes.size());
        std::vector<std::int64_t> sizes(static_cast<std::size_t>(count_));
        wait_for_all();
        require(MPI_Allgather(&size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, MPI_COMM_WORLD));
        const Layout in(sizes);
        Bytes received(in.bytes);
        std::ranges::copy(bytes, in.part_in(received, static_cast<std::size_t>(rank_)));
        require(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, received.data(), in.blocks.data(), in.offsets.data(),
                               block_, MPI_COMM_WORLD));
        traffic_.bytes += size * (count_ - 1);
        return in.parts_of(received);
    }

    void broadcast(std::span<std::byte> bytes) override {
        const Stopwatch stopwatch(traffic_);
        constexpr std::size_t at_once = std::size_t{1} << 30;
        for (std::size_t begin = 0; begin < bytes.size(); begin += at_once) {
            const std::span<std::byte> part = bytes.subspan(begin, std::min(at_once, bytes.size() - begin));
            wait_for_all();
            require(MPI_Bcast(part.data(), static_cast<int>(part.size()), MPI_BYTE, 0, MPI_COMM_WORLD));
        }
        if (rank_ == 0) traffic_.bytes += static_cast<std::int64_t>(bytes.size());
    }

    void abort(int exit_code) override {
        const TimeLimit limit(abort_limit, [] {});
        MPI_Abort(MPI_COMM_WORLD, exit_code);
        std::abort();  // MPI_Abort() does not return
    }

    Traffic traffic() const override { return traffic_; }

  private:
    class Stopwatch {
      public:
        explicit Stopwatch(Traffic& traffic) : traffic_(traffic) {}
        ~Stopwatch() { traffic_.seconds += std::chrono::duration<double>(Clock::now() - start_).count(); }
        Stopwatch(const Stopwatch&) = delete;
        Stopwatch& operator=(const Stopwatch&) = delete;

      private:
        Traffic& traffic_;
        Clock::time_point start_ = Clock::now();
    };

    /// Waits for all processes with the processor free for others; blocking functions of MPI would use it fully. A
    /// pause is 1/32 of the time waited, so the delay is at most 3% of that time. Measured: 1 us for two processes on
    /// idle cores; a wait of 5 s uses 15 ms of processor time.
    void wait_for_all() const {
        // On busy machines yield() costs milliseconds, so short waits keep the processor.
        constexpr std::chrono::nanoseconds short_wait = 100us;
        constexpr std::chrono::nanoseconds min_pause = 50us, max_pause = 5ms;  // sleep has a precision of 50 us
        MPI_Request all = MPI_REQUEST_NULL;
        require(MPI_Ibarrier(MPI_COMM_WORLD, &all));
        const Clock::time_point start = Clock::now();
        for (;;) {
            int are_here = 0;
            require(MPI_Test(&all, &are_here, MPI_STATUS_IGNORE));
            if (are_here) return;
            const std::chrono::nanoseconds waited = Clock::now() - start, pause = std::min(max_pause, waited / 32);
            if (pause >= min_pause)
                std::this_thread::sleep_for(pause);
            else if (waited > short_wait)
                std::this_thread::yield();
        }
    }

    FaultReport report_;
    int rank_ = 0, count_ = 1;
    MPI_Datatype block_ = MPI_DATATYPE_NULL;
    Traffic traffic_;
    std::optional<Heartbeat> heartbeat_;
};

}  // namespace

std::shared_ptr<Ranks> join_ranks(const FaultReport& report) {
    const std::optional<int> launched = launched_processes();
    if (!launched) return nullptr;
    const int rank = launched_rank().value_or(0);  // read before MPI_Init_thread(), which sets such variables itself
    // Before the heartbeat, only this limit detects a stopped process.
    const TimeLimit limit =
        common_limit(rank, start_limit, report, "not all processes have started within a minute: one is stopped");
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
    const auto ranks = std::make_shared<MpiRanks>(report);
    if (std::max(*launched, rank + 1) > ranks->count())
        throw std::runtime_error(fmt::format(
            "a launcher started several processes, but MPI connects {}: start them with mpirun, or with srun and PMIx",
            ranks->count()));
    if (provided < MPI_THREAD_MULTIPLE && ranks->count() > 1)
        throw std::runtime_error("this MPI library supports only one thread: processes could not watch each other");
    ranks->start_heartbeat();
    return ranks;
}

}  // namespace interflect
