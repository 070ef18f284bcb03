// Cells of the regular 1:4 subdivision: the parts cover the whole, and search finds the part that contains a point.
#include "interflect/elements/cell.h"
#include "tests/support/parameter_names.h"

#include <gtest/gtest.h>

#include <random>

namespace interflect {

using namespace detail;
namespace {

bool holds(const Cell& cell, Parameters p, bool triangle) {
    const float s = (p.u - cell.u) / cell.size, t = (p.v - cell.v) / cell.size, tolerance = 1e-4f;
    const bool in_square = s >= -tolerance && t >= -tolerance && s <= 1 + tolerance && t <= 1 + tolerance;
    return in_square && (!triangle || s + t <= 1 + tolerance);
}

class Cells : public testing::TestWithParam<bool> {};  // triangle

TEST_P(Cells, ChildAtNamesTheChildThatHoldsThePoint) {
    const bool triangle = GetParam();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0.001f, 0.999f);
    for (int i = 0; i < 1000; ++i) {
        Parameters p{uniform(random), uniform(random)};
        if (triangle && p.u + p.v > 1) p = {1 - p.u, 1 - p.v};
        Cell cell;
        for (int level = 0; level < 8; ++level) {
            cell = cell.child(cell.child_at(p, triangle), triangle);
            ASSERT_TRUE(holds(cell, p, triangle)) << p.u << " " << p.v << " at level " << level;
        }
    }
}

TEST_P(Cells, ChildrenAreQuarters) {
    const bool triangle = GetParam();
    const Cell parent{0.25f, 0.5f, -0.25f};
    float area = 0;
    for (unsigned k = 0; k < 4; ++k) {
        const Cell child = parent.child(k, triangle);
        area += child.size * child.size;
        EXPECT_TRUE(holds(parent, child.centre(triangle), triangle));
        EXPECT_EQ(parent.child_at(child.centre(triangle), triangle), k);
    }
    EXPECT_FLOAT_EQ(area, parent.size * parent.size);
}

INSTANTIATE_TEST_SUITE_P(Shape, Cells, testing::Bool(), testing_support::printed_name);

}  // namespace
}  // namespace interflect
