#include "interflect/geometry/search/wide_box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "interflect/base/numbers/random.h"

namespace interflect {

using namespace detail;
namespace {

std::vector<Boxed> random_boxes(std::size_t count, float size) {
    std::vector<Boxed> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto a = random_words(1, i), b = random_words(2, i);
        const V3f low(unit_float(a[0]), unit_float(a[1]), unit_float(a[2]));
        boxes.push_back({{low, low + size * V3f(unit_float(b[0]), unit_float(b[1]), unit_float(b[2]))}, i});
    }
    return boxes;
}

std::vector<std::uint32_t> found_in(const WideBoxTree& tree, const Imath::Box3f& box) {
    std::vector<std::uint32_t> found;
    tree.search(
        box, [](const Imath::Box3f&) { return true; }, [&](std::uint32_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

TEST(WideBoxTree, FindsTheBoxesThatIntersect) {
    // Sizes close to full nodes, and a size that needs several tasks
    for (const std::size_t count : {0, 1, 7, 8, 9, 63, 64, 65, 511, 513, 20'000}) {
        const std::vector<Boxed> boxes = random_boxes(count, 0.1f);
        const WideBoxTree tree(boxes);
        for (const Boxed& query : random_boxes(50, 0.3f)) {
            std::vector<std::uint32_t> expected;
            for (const Boxed& b : boxes)
                if (b.box.intersects(query.box)) expected.push_back(b.index);
            EXPECT_EQ(found_in(tree, query.box), expected) << count << " boxes";
        }
    }
}

TEST(WideBoxTree, FindsBoxesThatTouchInAPoint) {
    const WideBoxTree tree({{{{0, 0, 0}, {1, 1, 1}}, 5}});
    EXPECT_EQ(found_in(tree, {{1, 1, 1}, {2, 2, 2}}), std::vector<std::uint32_t>{5});
    EXPECT_TRUE(found_in(tree, {{1, 1, 1.0000002f}, {2, 2, 2}}).empty());
}

TEST(WideBoxTree, TestsTheOwnBoxOfEachElement) {
    const std::vector<Boxed> boxes = random_boxes(1000, 0.01f);
    const WideBoxTree tree(boxes);
    const auto reaches = [](const Imath::Box3f& box) { return box.min.x < 0.25f; };
    std::size_t found = 0;
    tree.search({V3f(-1), V3f(2)}, reaches, [&](std::uint32_t i) {
        EXPECT_TRUE(reaches(boxes[i].box));
        ++found;
    });
    EXPECT_EQ(found, std::count_if(boxes.begin(), boxes.end(), [&](const Boxed& b) { return reaches(b.box); }));
}

TEST(WideBoxTree, AcceptsEqualBoxes) {
    const WideBoxTree tree(std::vector<Boxed>(100, {{{0, 0, 0}, {1, 1, 1}}, 3}));
    EXPECT_EQ(found_in(tree, {{0, 0, 0}, {1, 1, 1}}), std::vector<std::uint32_t>(100, 3));
}

}  // namespace
}  // namespace interflect
