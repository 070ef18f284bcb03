// The forest of quadtrees: areas, search, concurrent subdivision, values per element.
#include "interflect/elements/forest.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <random>

#include "interflect/core.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

constexpr std::size_t capacity = 1 << 16;

/// A parallelogram, an irregular convex quadrilateral and a triangle.
Scene three_shapes() {
    Scene scene;
    testing_support::add_material(scene, Rgb(0.5f), Rgb(0));
    testing_support::add_rectangle(scene, V3f(0, 0, 0), V3f(2, 0, 0), V3f(1, 1, 0), 0);
    scene.vertices.insert(scene.vertices.end(), {V3f(0, 0, 1), V3f(3, 0, 1), V3f(2, 2, 1), V3f(0, 1, 1)});
    Patch irregular, triangle;
    irregular.vertices = {4, 5, 6, 7};
    triangle.vertices = {4, 5, 6, none};
    scene.patches.insert(scene.patches.end(), {irregular, triangle});
    return scene;
}

/// Subdivides `count` leaves chosen at random.
void subdivide_at_random(ElementForest& forest, int count, unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < count; ++i) {
        const std::vector<ElementIndex> leaves = forest.leaves();
        forest.subdivide(leaves[random() % leaves.size()]);
    }
}

double leaf_area(const ElementForest& forest, PatchIndex patch) {
    double area = 0;
    for (const ElementIndex e : forest.leaves()) area += forest.patch(e) == patch ? forest.area(e) : 0;
    return area;
}

TEST(Forest, LeavesCoverTheirPatch) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity);
    subdivide_at_random(forest, 300, 1);
    for (PatchIndex p{0}; p < forest.patch_count(); ++p)
        EXPECT_NEAR(leaf_area(forest, p), patch_area(scene, scene.patches[p]), 1e-5);
}

TEST(Forest, CellAreaIsTheShareOfPointsThatFallIntoIt) {
    // The irregular quadrilateral: its cells differ in area though their parameter ranges are equal.
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity);
    const ElementIndex child = forest.subdivide(ElementIndex(1));
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    constexpr int points = 100'000;
    std::array<int, 4> hits{};
    for (int i = 0; i < points; ++i)
        ++hits[forest.leaf_at(PatchIndex(1),
                              forest.geometry(PatchIndex(1)).uniform_parameters(uniform(random), uniform(random))) -
               child];
    for (std::uint32_t k = 0; k < 4; ++k) {
        const double share = forest.area(child + k) / forest.area(ElementIndex(1));
        const double sigma = std::sqrt(share * (1 - share) / points);
        EXPECT_NEAR(static_cast<double>(hits[k]) / points, share, 4 * sigma);  // false alarm 6e-5 each
        EXPECT_GT(std::abs(share - 0.25), 8 * sigma) << "equal areas would prove nothing";
    }
}

TEST(Forest, LeafAtFindsTheLeafWhoseCellHoldsThePoint) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity);
    subdivide_at_random(forest, 200, 3);
    for (const ElementIndex leaf : forest.leaves()) {
        const bool triangle = forest.geometry(forest.patch(leaf)).is_triangle();
        EXPECT_EQ(forest.leaf_at(forest.patch(leaf), forest.cell(leaf).centre(triangle)), leaf);
    }
}

std::vector<std::array<std::uint32_t, 4>> described(const ElementForest& forest) {
    std::vector<std::array<std::uint32_t, 4>> d;
    for (ElementIndex e{0}; e < forest.size(); ++e)
        d.push_back({forest.patch(e), forest.path(e), forest.parent(e), forest.first_child(e)});
    return d;
}

TEST(Forest, IsTheSameWhateverTheOrderOfSubdivision) {
    const Scene scene = three_shapes();
    ElementForest a(scene, capacity), b(scene, capacity);
    for (const std::uint32_t patch : {0, 1, 2}) a.subdivide(a.subdivide(ElementIndex(patch)) + 2);
    for (const std::uint32_t patch : {2, 0, 1}) b.subdivide(b.subdivide(ElementIndex(patch)) + 2);
    EXPECT_NE(described(a), described(b));
    a.put_in_order(a.patch_count());
    b.put_in_order(b.patch_count());
    EXPECT_EQ(described(a), described(b));
}

TEST(Forest, TakesBackTheLastSiblings) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity), smaller(scene, capacity);
    smaller.subdivide(ElementIndex(1));
    const ElementIndex child = forest.subdivide(ElementIndex(1));
    forest.subdivide(child + 3);
    EXPECT_EQ(forest.drop_last_siblings(), child + 3);
    EXPECT_EQ(described(forest), described(smaller));
    EXPECT_TRUE(forest.is_leaf(child + 3));
    EXPECT_EQ(forest.subdivide(child + 3), child + 4) << "and makes them again";
}

TEST(Forest, RefusesWhatDoesNotFit) {
    const Scene scene = three_shapes();
    ElementForest full(scene, scene.patches.size() + 4);
    EXPECT_NE(full.subdivide(ElementIndex(0)), none);
    EXPECT_EQ(full.subdivide(ElementIndex(1)), none);
    EXPECT_TRUE(full.is_leaf(ElementIndex(1)));
    EXPECT_EQ(full.size(), scene.patches.size() + 4);

    ElementForest deep(scene, capacity);
    ElementIndex e(0);
    for (int level = 0; level < ElementForest::deepest_level; ++level) e = deep.subdivide(e);
    EXPECT_EQ(deep.level(e), ElementForest::deepest_level);
    EXPECT_EQ(deep.subdivide(e), none);
}

TEST(Forest, GoesFromTheRootsToTheLeavesAndBackPastNoGeneration) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, 1 << 20);
    std::mt19937 random(6);
    for (unsigned batch = 0; batch < 4; ++batch) {  // the last batch is left unsorted
        const std::uint32_t first = forest.size();
        for (int i = 0; i < 20'000; ++i)
            forest.subdivide(ElementIndex(static_cast<std::uint32_t>(random()) % forest.size()));
        if (batch == 3) break;
        forest.put_in_order(first);
        if (batch == 1)
            for (int i = 0; i < 6'000; ++i) forest.drop_last_siblings();
    }
    std::vector<std::uint32_t> depth(forest.size(), 0), height(forest.size(), 0);
    std::atomic<std::uint32_t> visits{0};
    forest.for_siblings_from_roots([&](ElementIndex first) {
        for (ElementIndex e = first; e < first + 4; ++e) depth[e] = depth[forest.parent(first)] + 1;
        ++visits;
    });
    forest.for_siblings_from_leaves([&](ElementIndex first) {
        for (ElementIndex e = first; e < first + 4; ++e)
            height[forest.parent(first)] = std::max(height[forest.parent(first)], height[e] + 1);
        ++visits;
    });
    EXPECT_EQ(visits, 2 * (forest.size() - forest.patch_count()) / 4);
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        ASSERT_EQ(depth[e], forest.level(e));
        ASSERT_EQ(height[e] > 0, !forest.is_leaf(e));
        ASSERT_TRUE(e < forest.patch_count() || height[forest.parent(e)] > height[e]);
    }
}

TEST(Forest, PushAndPullKeepTheIntegral) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity);
    subdivide_at_random(forest, 100, 4);
    forest.put_in_order(forest.patch_count());
    std::mt19937 random(5);
    std::vector<float> values(forest.size());
    double integral = 0;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        values[e] = static_cast<float>(random() % 100);
        integral += static_cast<double>(values[e]) * forest.area(e);
    }
    push(forest, values);
    pull(forest, values);
    double at_leaves = 0, at_roots = 0;
    for (const ElementIndex e : forest.leaves()) at_leaves += static_cast<double>(values[e]) * forest.area(e);
    for (ElementIndex e{0}; e < forest.patch_count(); ++e) at_roots += static_cast<double>(values[e]) * forest.area(e);
    EXPECT_NEAR(at_leaves, integral, 1e-4 * integral);
    EXPECT_NEAR(at_roots, integral, 1e-4 * integral);
}

TEST(Forest, RefusesACapacityThatCannotBe) {
    const Scene scene = three_shapes();
    EXPECT_THROW(ElementForest(scene, scene.patches.size() - 1), InputError);
    EXPECT_THROW(ElementForest(scene, 0xffffffffu), InputError);
}

TEST(Forest, RefusesVerticesThatAreNotThere) {
    Scene scene = three_shapes();
    scene.vertices.pop_back();
    EXPECT_THROW(ElementForest(scene, 100), InputError);
}

TEST(Forest, NewElementsInherit) {
    const Scene scene = three_shapes();
    ElementForest forest(scene, capacity);
    std::vector<float> values{1, 2, 3};
    const ElementIndex child = forest.subdivide(ElementIndex(1)), grandchild = forest.subdivide(child + 3);
    inherit(forest, forest.patch_count(), values);
    EXPECT_EQ(values[child], 2);
    EXPECT_EQ(values[grandchild + 1], 2);
}

}  // namespace
}  // namespace interflect
