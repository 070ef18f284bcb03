#include "interflect/formats/shapes/transform_sequence.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

namespace interflect {

using namespace detail;
namespace {

using Imath::V3d;

TransformSequence parse(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return TransformSequence(std::vector<std::string_view>(words.begin(), words.end()));
}

V3d apply(const std::string& text, const V3d& point, const std::vector<int>& copy = {}) {
    return point * parse(text).matrix(copy);
}

TEST(TransformSequence, EachTransform) {
    EXPECT_EQ(apply("-t 1 2 3", {1, 1, 1}), V3d(2, 3, 4));
    EXPECT_EQ(apply("-s 2", {1, 2, 3}), V3d(2, 4, 6));
    EXPECT_EQ(apply("-mx", {1, 2, 3}), V3d(-1, 2, 3));
    EXPECT_EQ(apply("-my", {1, 2, 3}), V3d(1, -2, 3));
    EXPECT_EQ(apply("-mz", {1, 2, 3}), V3d(1, 2, -3));
}

TEST(TransformSequence, QuarterTurnsAreCounterClockwiseAndExact) {
    EXPECT_EQ(apply("-rx 90", {1, 2, 3}), V3d(1, -3, 2));
    EXPECT_EQ(apply("-ry 90", {1, 2, 3}), V3d(3, 2, -1));
    EXPECT_EQ(apply("-rz 90", {1, 2, 3}), V3d(-2, 1, 3));
    EXPECT_EQ(apply("-rz -270", {1, 2, 3}), V3d(-2, 1, 3));
    EXPECT_EQ(apply("-rz 540", {1, 2, 3}), V3d(-1, -2, 3));
}

TEST(TransformSequence, OtherAngles) {
    EXPECT_LT((apply("-rz 30", {1, 0, 0}) - V3d(std::sqrt(0.75), 0.5, 0)).length(), 1e-15);
}

TEST(TransformSequence, ActFromLeftToRight) {
    EXPECT_EQ(apply("-t 1 0 0 -rz 90", {0, 0, 0}), V3d(0, 1, 0));
    EXPECT_EQ(apply("-rz 90 -t 1 0 0", {0, 0, 0}), V3d(1, 0, 0));
}

TEST(TransformSequence, RepetitionCoversWhatFollowsIt) {
    EXPECT_EQ(apply("-t 0 5 0 -i 3 -t 1 0 0", {0, 0, 0}), V3d(3, 5, 0));
    EXPECT_EQ(apply("-i 0 -t 1 0 0 -i 2 -s 3", {1, 0, 0}), V3d(9, 0, 0));
    EXPECT_EQ(apply("-i 1000000000 -rz 90", {1, 0, 0}), V3d(1, 0, 0));
}

TEST(TransformSequence, ArrayRepeatsByTheCopysIndex) {
    const TransformSequence grid = parse("-t 0 0 9 -a 2 -t 1 0 0 -a 3 -t 0 1 0");
    EXPECT_EQ(std::vector<int>(grid.array_sizes().begin(), grid.array_sizes().end()), (std::vector<int>{2, 3}));
    EXPECT_EQ(V3d(0) * grid.matrix(std::vector<int>{0, 0}), V3d(0, 0, 9));
    EXPECT_EQ(V3d(0) * grid.matrix(std::vector<int>{1, 2}), V3d(1, 2, 9));
    EXPECT_FALSE(parse("-t 1 0 0").is_array());
}

TEST(TransformSequence, WrongArgumentsAreRefused) {
    for (const char* text : {"-t 1 2", "-t 1 2 x", "-rx", "-ra 3", "-s 0", "-s nan", "-mw", "-i -1", "-i 1.5", "-a 0",
                             "-a", "5", "t 1 2 3", "-T 1 2 3", "-rxy 3"})
        EXPECT_THROW(parse(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace interflect
