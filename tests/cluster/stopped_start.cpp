// Preloaded by tests of mpirun: stops the second process between MPI_Init() and its heartbeat. The steady clock runs 20
// times faster, and the limit of the start passes in three seconds.

#include <dlfcn.h>
#include <mpi.h>
#include <pthread.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace {

constexpr std::int64_t speed = 20, second = 1'000'000'000;  // [ns]

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * second + time.tv_nsec; }
timespec as_timespec(std::int64_t time) { return {time / second, time % second}; }

template <class Function>
Function* next(Function*, const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

timespec real_time(clockid_t clock) {
    static const auto gettime = next(&clock_gettime, "clock_gettime");
    timespec time{};
    gettime(clock, &time);
    return time;
}

}  // namespace

extern "C" int MPI_Comm_dup(MPI_Comm communicator, MPI_Comm* copy) {
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    if (rank && std::string_view(rank) == "1") std::raise(SIGSTOP);
    return PMPI_Comm_dup(communicator, copy);
}

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
    *time = real_time(clock);
    if (clock == CLOCK_MONOTONIC) *time = as_timespec(nanoseconds(*time) * speed);
    return 0;
}

extern "C" int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                                      const timespec* end) {
    static const auto wait = next(&pthread_cond_clockwait, "pthread_cond_clockwait");
    const timespec real_end = clock == CLOCK_MONOTONIC ? as_timespec(nanoseconds(*end) / speed) : *end;
    return wait(condition, mutex, clock, &real_end);
}
