#include "interflect/base/numbers/ranked_bits.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace interflect {

using namespace detail;
namespace {

TEST(RankedBits, KnowsItsMembersAndHowManyAreBeforeEach) {
    const std::vector<std::uint32_t> members = {0, 1, 63, 64, 100, 128, 191, 192};
    const RankedBits set(193, members);
    for (std::uint32_t number = 0; number < 193; ++number) {
        const auto at = std::lower_bound(members.begin(), members.end(), number);
        const bool is_member = at != members.end() && *at == number;
        EXPECT_EQ(set[number], is_member) << number;
        if (is_member) {
            EXPECT_EQ(set.rank(number), static_cast<std::uint32_t>(at - members.begin())) << number;
        }
    }
}

TEST(RankedBits, MayHaveNoMembers) {
    const RankedBits none_of_64(64, std::vector<std::uint32_t>()), none_at_all;
    for (std::uint32_t number = 0; number < 64; ++number) {
        EXPECT_FALSE(none_of_64[number]);
        EXPECT_FALSE(none_at_all[number]);
    }
}

}  // namespace
}  // namespace interflect
