#include "interflect/exports/records/json_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace interflect {

using namespace detail;
namespace {

TEST(JsonText, KeepsNamesOfAnyBytes) {
    const Json json{{"name", "b\xfcro \\x41"}, {"list", {"\x1b[0m", "wände"}}, {"number", 2}};
    const std::string text = json_text(json);
    EXPECT_EQ(text, R"({"name":"b\\xfcro \\x5cx41","list":["\\x1b[0m","wände"],"number":2})");
    EXPECT_EQ(parse_json_text(text), json);
}

TEST(JsonText, RefusesNumbersThatJsonDoesNotHave) {
    for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const Json json{{"good", {1.5, nullptr}}, {"outer", {{"power", {1.0, wrong}}}}};
        try {
            json_text(json);
            FAIL() << wrong;
        } catch (const std::runtime_error& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr("'power' is not finite"));
        }
    }
}

TEST(ShortestNumber, IsTheFloatInFewDigits) {
    EXPECT_EQ(Json(shortest_number(0.1f)).dump(), "0.1");
    EXPECT_EQ(Json(shortest_number(1.6f)).dump(), "1.6");
    std::mt19937 random(1);
    for (int trial = 0; trial < 200'000; ++trial) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(static_cast<float>(shortest_number(value)), value);
    }
}

}  // namespace
}  // namespace interflect
