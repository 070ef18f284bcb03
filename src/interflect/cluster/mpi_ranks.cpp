#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "interflect/ranks.h"

namespace interflect {

namespace {

using Clock = std::chrono::steady_clock;

int checked_size(std::size_t bytes) {
    if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw std::runtime_error("a process has more than 2 GiB to send at once: use more processes or fewer elements");
    return static_cast<int>(bytes);
}

/// Places of parts that follow each other.
struct Layout {
    std::vector<int> sizes, places;

    explicit Layout(std::vector<int> s) : sizes(std::move(s)), places(sizes.size()) {
        std::size_t place = 0;
        for (std::size_t r = 0; r < sizes.size(); ++r)
            places[r] = checked_size(place), place += static_cast<std::size_t>(sizes[r]);
        checked_size(place);
    }
    std::size_t bytes() const {
        return static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
    }
    std::vector<Ranks::Bytes> parts_of(const Ranks::Bytes& all) const {
        std::vector<Ranks::Bytes> parts;
        for (std::size_t r = 0; r < sizes.size(); ++r)
            parts.emplace_back(all.begin() + places[r], all.begin() + places[r] + sizes[r]);
        return parts;
    }
};

class MpiRanks : public Ranks {
  public:
    MpiRanks() {
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
    }
    ~MpiRanks() override { MPI_Finalize(); }

    int rank() const override { return rank_; }
    int count() const override { return count_; }

    std::vector<Bytes> exchange(const std::vector<Bytes>& parts) override {
        const Stopwatch stopwatch(traffic_);
        std::vector<int> sizes, sizes_here(parts.size());
        Bytes all;
        for (const Bytes& part : parts) {
            sizes.push_back(checked_size(part.size()));
            all.insert(all.end(), part.begin(), part.end());
        }
        MPI_Alltoall(sizes.data(), 1, MPI_INT, sizes_here.data(), 1, MPI_INT, MPI_COMM_WORLD);
        const Layout out(sizes), in(sizes_here);
        Bytes received(in.bytes());
        MPI_Alltoallv(all.data(), out.sizes.data(), out.places.data(), MPI_BYTE, received.data(), in.sizes.data(),
                      in.places.data(), MPI_BYTE, MPI_COMM_WORLD);
        traffic_.bytes += static_cast<std::int64_t>(all.size() - parts[static_cast<std::size_t>(rank_)].size());
        return in.parts_of(received);
    }

    std::vector<Bytes> gather(std::span<const std::byte> bytes) override {
        const Stopwatch stopwatch(traffic_);
        const int size = checked_size(bytes.size());
        std::vector<int> sizes(static_cast<std::size_t>(count_));
        MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
        const Layout in(sizes);
        Bytes received(in.bytes());
        MPI_Allgatherv(bytes.data(), size, MPI_BYTE, received.data(), in.sizes.data(), in.places.data(), MPI_BYTE,
                       MPI_COMM_WORLD);
        traffic_.bytes += static_cast<std::int64_t>(bytes.size()) * (count_ - 1);
        return in.parts_of(received);
    }

    void broadcast(std::span<std::byte> bytes) override {
        const Stopwatch stopwatch(traffic_);
        constexpr std::size_t at_once = std::size_t{1} << 30;
        for (std::size_t begin = 0; begin < bytes.size(); begin += at_once) {
            const std::span<std::byte> part = bytes.subspan(begin, std::min(at_once, bytes.size() - begin));
            MPI_Bcast(part.data(), static_cast<int>(part.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
        }
        if (rank_ == 0) traffic_.bytes += static_cast<std::int64_t>(bytes.size());
    }

    void abort(int exit_code) override {
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

    int rank_ = 0, count_ = 1;
    Traffic traffic_;
};

}  // namespace

std::shared_ptr<Ranks> join_ranks() {
    const char* count = std::getenv("OMPI_COMM_WORLD_SIZE");
    if (!count) return nullptr;  // not started by mpirun
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    return std::make_shared<MpiRanks>();
}

}  // namespace interflect
