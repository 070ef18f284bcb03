#include "interflect/base/memory/stable_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace interflect {

using namespace detail;
namespace {

TEST(StableArray, IsZeroAndKeepsWhatIsWritten) {
    StableArray<std::uint32_t> array(1'000'000);
    EXPECT_EQ(array.capacity(), 1'000'000u);
    for (const std::size_t i : {0u, 4321u, 999'999u}) {
        EXPECT_EQ(array[i], 0u);
        array[i] = 7;
        EXPECT_EQ(array[i], 7u);
    }
}

/// Larger than the memory of any machine; only the pages in use exist.
TEST(StableArray, ReservesAddressesNotMemory) {
    StableArray<std::uint64_t> array(std::size_t{1} << 36);
    array[std::size_t{1} << 35] = 1;
    EXPECT_EQ(array[std::size_t{1} << 35], 1u);
}

/// Seen to fail when a failed reservation is ignored, and when the message counts entries instead of bytes.
TEST(StableArray, NamesTheLimitWhereAddressesCannotBeReserved) {
    try {
        const StableArray<std::uint64_t> array(std::size_t{1} << 50);
        FAIL() << "reserved";
    } catch (const AddressSpaceError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("8589934593 MiB of address space"));
        EXPECT_THAT(e.what(), testing::HasSubstr("limit"));
    }
}

TEST(StableArray, MovesWithItsContent) {
    StableArray<int> first(10);
    first[3] = 5;
    const int* place = &first[3];
    const StableArray<int> second = std::move(first);
    EXPECT_EQ(&second[3], place);
    EXPECT_EQ(second[3], 5);
}

}  // namespace
}  // namespace interflect
