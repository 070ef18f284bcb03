#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#if defined(__SANITIZE_THREAD__)
#define INTERFLECT_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define INTERFLECT_THREAD_SANITIZER 1
#endif
#endif
#ifdef INTERFLECT_THREAD_SANITIZER
#include <array>
#include <atomic>
#include <thread>
#endif

namespace interflect::detail {

/// ThreadSanitizer cannot follow TBB's allocator, hence std::allocator.
template <class T>
using PerThread = tbb::enumerable_thread_specific<T, std::allocator<T>>;

/// Thrown by the functions below once the task group of the caller is cancelled, because their results are incomplete.
struct Cancelled {};

inline void require_not_cancelled() {
    if (tbb::is_current_task_group_canceling()) throw Cancelled();
}

/// Calls body(begin, end) for ranges of at most `grain` indices in [0, count), independent of the number of threads.
template <class Body>
void parallel_for_ranges(std::size_t count, std::size_t grain, const Body& body) {
    const std::size_t ranges = (count + grain - 1) / grain;
    const auto do_range = [&](std::size_t range) { body(range * grain, std::min(count, (range + 1) * grain)); };
    if (ranges <= 1) {
        if (ranges == 1) do_range(0);
        return;
    }
#ifdef INTERFLECT_THREAD_SANITIZER
    // ThreadSanitizer reports TBB's tasks as races.
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t range = next++; range < ranges; range = next++) do_range(range);
    };
    std::array<std::thread, 2> others{std::thread(work), std::thread(work)};
    work();
    for (std::thread& other : others) other.join();
#else
    tbb::parallel_for(std::size_t{0}, ranges, do_range);
    require_not_cancelled();
#endif
}

/// Calls body(index), which takes little time, for the indices in [0, count).
template <class Body>
void parallel_for_indices(std::size_t count, const Body& body) {
    constexpr std::size_t grain = 4096;
    parallel_for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Adds the results of body(begin, end) for the ranges of parallel_for_ranges() in their order: equal bits for any
/// number of threads.
template <class T, class Body>
T parallel_sum(std::size_t count, std::size_t grain, const T& zero, const Body& body) {
    std::vector<T> parts((count + grain - 1) / grain, zero);
    parallel_for_ranges(count, grain,
                        [&](std::size_t begin, std::size_t end) { parts[begin / grain] = body(begin, end); });
    T sum = zero;
    for (const T& part : parts) sum += part;
    return sum;
}

/// @param less  A total order, because the sort is not stable.
template <class T, class Less>
void parallel_sort(std::vector<T>& values, const Less& less) {
#ifdef INTERFLECT_THREAD_SANITIZER
    std::sort(values.begin(), values.end(), less);
#else
    tbb::parallel_sort(values.begin(), values.end(), less);
    require_not_cancelled();
#endif
}

template <class A, class B>
void parallel_invoke(const A& a, const B& b) {
#ifdef INTERFLECT_THREAD_SANITIZER
    a();
    b();
#else
    tbb::parallel_invoke(a, b);
    require_not_cancelled();
#endif
}

}  // namespace interflect::detail
