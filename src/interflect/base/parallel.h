#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define INTERFLECT_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define INTERFLECT_THREAD_SANITIZER 1
#endif
#endif
#ifdef INTERFLECT_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace interflect {

/// Calls body(begin, end) for ranges that partition [0, count), on all threads; each range is at most `grain` long and
/// starts at a multiple of it, so that the partition does not depend on the number of threads.
template <class Body>
void parallel_for_ranges(std::size_t count, std::size_t grain, const Body& body) {
    const std::size_t ranges = (count + grain - 1) / grain;
    // ThreadSanitizer does not see the fork and join inside the (uninstrumented) TBB library: tell it.
    [[maybe_unused]] char fork = 0, join = 0;
#ifdef INTERFLECT_THREAD_SANITIZER
    __tsan_release(&fork);
#endif
    tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t range) {
#ifdef INTERFLECT_THREAD_SANITIZER
        __tsan_acquire(&fork);
#endif
        body(range * grain, std::min(count, (range + 1) * grain));
#ifdef INTERFLECT_THREAD_SANITIZER
        __tsan_release(&join);
#endif
    });
#ifdef INTERFLECT_THREAD_SANITIZER
    __tsan_acquire(&join);
#endif
}

}  // namespace interflect
