#include "interflect/base/files/state_archive.h"

#include <ImathVec.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace interflect {

using namespace detail;
namespace {

/// A value that was written as the bytes of another, and the function that reads it.
template <class Stored, class T>
StateArchive archive_with(const Stored& stored, T&) {
    const auto bytes = std::as_bytes(std::span(&stored, 1));
    return StateArchive({{"x", {bytes.begin(), bytes.end()}}});
}

template <class T>
bool is_read(T stored) {
    T value{};
    try {
        archive_with(stored, value)("x", value);
    } catch (const std::runtime_error&) {
        return false;
    }
    return value == stored;
}

template <class T>
bool is_amount(T stored) {
    T value{};
    try {
        archive_with(stored, value).amounts("x", value);
    } catch (const std::runtime_error&) {
        return false;
    }
    return value == stored;
}

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

TEST(StateArchive, ReadsFiniteNumbersAndNonNegativeIntegers) {
    EXPECT_TRUE(is_read(-1.5));
    EXPECT_FALSE(is_read(nan));
    EXPECT_FALSE(is_read(infinity));
    EXPECT_FALSE(is_read(-std::numeric_limits<float>::infinity()));
    EXPECT_TRUE(is_read(std::int64_t{1} << 40));
    EXPECT_FALSE(is_read(std::int64_t{-1}));
    EXPECT_FALSE(is_read(-7));
    EXPECT_TRUE(is_read(~std::uint64_t{0}));
    EXPECT_TRUE(is_read(Imath::V3f(1, -2, 3)));
    EXPECT_FALSE(is_read(Imath::V3d(1, 2, nan)));
    EXPECT_TRUE(is_read(std::array{1.0, 2.0}));
    EXPECT_FALSE(is_read(std::array{1.0, infinity}));
    EXPECT_FALSE(is_read(std::array{std::array{1.0f}, std::array{std::numeric_limits<float>::infinity()}}));
}

TEST(StateArchive, ReadsNonNegativeAmounts) {
    EXPECT_TRUE(is_amount(0.0));
    EXPECT_TRUE(is_amount(2.5f));
    EXPECT_FALSE(is_amount(-1e-30));
    EXPECT_FALSE(is_amount(nan));
    EXPECT_FALSE(is_amount(Imath::V3f(1, -2, 3)));
}

TEST(StateArchive, ReadsVectorsThatAreAllInRange) {
    for (const float last : {2.0f, -2.0f, std::numeric_limits<float>::infinity()}) {
        std::vector<float> values, written{1, 0, last};
        StateArchive out;
        out("x", written);
        const auto& bytes = out.written().front().second;
        const auto read = [&] {
            StateArchive({{"x", {bytes.begin(), bytes.end()}}}).amounts("x", values);
            return values;
        };
        if (last == 2)
            EXPECT_EQ(read(), written);
        else
            EXPECT_THROW(read(), std::runtime_error) << last;
    }
}

TEST(StateArchive, ReadsOnlyTwoTruthValues) {
    for (int byte = 0; byte < 256; ++byte) {
        bool value = false;
        StateArchive archive({{"x", {static_cast<std::byte>(byte)}}});
        if (byte > 1) {
            EXPECT_THROW(archive("x", value), std::runtime_error) << byte;
        } else {
            archive("x", value);
            EXPECT_EQ(value, byte == 1);
        }
    }
}

TEST(StateArchive, NamesTheArrayThatIsOutOfRange) {
    double value = 0;
    StateArchive archive = archive_with(nan, value);
    try {
        archive("x", value);
        ADD_FAILURE() << "read";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "the state of the run has numbers out of range in 'x'");
    }
}

}  // namespace
}  // namespace interflect
