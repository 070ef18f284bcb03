#pragma once
/// Tests that run in the release build alone: statistics of many rays, and work that is refused after much of it.
/// Sanitizers look for faults of memory and of threads, which a few rays show, and slow each ray down many times. For
/// each of these tests, others run the same code under the sanitizers; some are named beside it. A test may also
/// compute its result first and leave only references and statistics to the release build, or use fewer rays if
/// is_sanitized.

#include <gtest/gtest.h>

#ifdef INTERFLECT_SANITIZED
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Skips the rest of a test, or the test of a SetUp(), in a build with a sanitizer.
#define RELEASE_ONLY() RELEASE_ONLY_IF(true)

/// The same for some of the parameters of a test.
#define RELEASE_ONLY_IF(condition) \
    if (is_sanitized && (condition)) GTEST_SKIP() << "left to the release build"
