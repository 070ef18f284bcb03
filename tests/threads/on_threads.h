#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace interflect::testing_support {

/// Returns run(), which works on this number of threads, also if it exceeds the number of cores.
template <class Run>
auto on_threads(int threads, const Run& run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(run);
}

/// Expects the same result of run() on one, two and five threads. Results are compared by `==`.
template <class Run>
void expect_same_bits(const Run& run) {
    const auto expected = on_threads(1, run);
    for (const int threads : {2, 5}) EXPECT_TRUE(on_threads(threads, run) == expected) << threads << " threads";
}

}  // namespace interflect::testing_support
