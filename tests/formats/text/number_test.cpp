#include "interflect/formats/text/number.h"

#include <gtest/gtest.h>

namespace interflect {

using namespace detail;
namespace {

TEST(Number, DecimalForms) {
    EXPECT_EQ(parse_number("12"), 12);
    EXPECT_EQ(parse_number("-.25"), -0.25);
    EXPECT_EQ(parse_number("+3."), 3);
    EXPECT_EQ(parse_number("1e-3"), 1e-3);
    EXPECT_EQ(parse_number("3.4e38"), 3.4e38);
}

TEST(Number, WhatIsNotFiniteInSinglePrecisionIsNone) {
    for (const char* text : {"nan", "-nan", "inf", "+inf", "infinity", "1e39", "-1e39", "1e400"})
        EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(Number, WhatIsNoDecimalNumberIsNone) {
    for (const char* text : {"", "-", "+", "+-1", "--1", "0x10", "1.0f", "1,5", "1 ", " 1", "one", "1e", "1.2.3"})
        EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(Number, Integers) {
    EXPECT_EQ(parse_integer("-7"), -7);
    EXPECT_EQ(parse_integer("1000000000"), 1'000'000'000);
    for (const char* text : {"", "1.0", "3000000000", "1e3", "x"}) EXPECT_EQ(parse_integer(text), std::nullopt) << text;
}

}  // namespace
}  // namespace interflect
