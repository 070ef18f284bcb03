#include "interflect/render/lights/light_tree.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;

std::vector<PatchGeometry> geometry_of(const Scene& scene) {
    std::vector<PatchGeometry> geometry;
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    return geometry;
}

LightTree tree_of(const Scene& scene) {
    const std::vector<PatchGeometry> geometry = geometry_of(scene);
    return {patch_lights(scene, geometry, emitted_powers(scene, geometry)), scene.patches.size()};
}

/// Lamps of different sizes and powers that face down and up, a tilted one, two-sided ones, and a surface without
/// emission.
Scene lamps() {
    Scene scene;
    const std::uint32_t dark = add_material(scene, Rgb(0.5f, 0.5f, 0.5f), Rgb(0, 0, 0));
    const std::uint32_t dim = add_material(scene, Rgb(0, 0, 0), Rgb(1, 2, 3));
    const std::uint32_t bright = add_material(scene, Rgb(0, 0, 0), Rgb(9e4f, 0, 0));
    add_rectangle(scene, V3f(-9, -9, 0), V3f(18, 0, 0), V3f(0, 18, 0), dark);
    add_rectangle(scene, V3f(-2, -2, 3), V3f(0, 1, 0), V3f(1, 0, 0), dim, 3, 2);
    add_rectangle(scene, V3f(4, 1, 2.5f), V3f(0, 0.01f, 0), V3f(0.01f, 0, 0), bright);
    add_rectangle(scene, V3f(1, 4, 2), V3f(1, 0, 0), V3f(0, 1, 1), dim, 2, 2, true);
    add_rectangle(scene, V3f(-4, 3, 1), V3f(1, 0, 0), V3f(0, 1, 0), dim);
    return scene;
}

struct Point {
    V3f x, n;
};
const std::vector<Point> points_of_surfaces = {
    {V3f(0, 0, 0), V3f(0, 0, 1)},          {V3f(-1.5f, -1.6f, 2.9f), V3f(0, 0, 1)}, {V3f(4, 1, 2.499f), V3f(0, 0, 1)},
    {V3f(1.5f, 4.2f, 2.3f), V3f(0, 1, 0)}, {V3f(8, 8, 0.1f), V3f(-0.6f, 0, 0.8f)},  {V3f(-5, 0, 8), V3f(0, 0, -1)}};

/// choose() for evenly spaced numbers agrees with probability(), except for numbers at the borders.
void expect_stated_probabilities(const Scene& scene, const LightTree& tree) {
    constexpr int count = 100'000;
    for (const auto& [x, n] : points_of_surfaces) {
        std::vector<int> chosen(scene.patches.size(), 0);
        for (int i = 0; i < count; ++i) {
            const LightTree::Choice choice = tree.choose(x, n, (i + 0.5) / count);
            if (choice.index == none) continue;
            ++chosen[choice.index];
            ASSERT_FLOAT_EQ(choice.probability, tree.probability(choice.index, x, n));
        }
        for (PatchIndex p{0}; p < scene.patches.size(); ++p)
            EXPECT_NEAR(static_cast<float>(chosen[p]) / count, tree.probability(p, x, n), 1e-4) << "patch " << p;
    }
}

TEST(LightTree, ChoosesWithTheStatedProbability) {
    const Scene scene = lamps();
    LightTree tree = tree_of(scene);
    expect_stated_probabilities(scene, tree);
    std::vector<float> weights;
    for (std::size_t i = 0; i < scene.patches.size(); ++i) weights.push_back(i % 3 == 0 ? 1e-4f : 1.0f);
    tree.weigh(weights);
    expect_stated_probabilities(scene, tree);
}

/// Half of the choices follow the weights.
TEST(LightTree, WeightsMoveHalfOfTheChoices) {
    Scene scene;
    const std::uint32_t bright = add_material(scene, Rgb(0), Rgb(1e4f)), dim = add_material(scene, Rgb(0), Rgb(1));
    for (const std::uint32_t material : {bright, dim})
        add_rectangle(scene, V3f(-1, -1, 1), V3f(0, 2, 0), V3f(2, 0, 0), material);
    LightTree tree = tree_of(scene);
    const V3f x(0), up(0, 0, 1);
    EXPECT_NEAR(tree.probability(1, x, up), 1e-4, 1e-6);
    tree.weigh(std::vector<float>{1e-8f, 1});
    EXPECT_NEAR(tree.probability(0, x, up), 0.5, 1e-3);
    EXPECT_NEAR(tree.probability(1, x, up), 0.5, 1e-3);
}

/// A patch that can light a point is chosen; tried for each corner of the patch, without occlusion.
TEST(LightTree, MissesNoPatchThatLightsAPoint) {
    const Scene scene = lamps();
    const std::vector<PatchGeometry> geometry = geometry_of(scene);
    const LightTree tree(patch_lights(scene, geometry, emitted_powers(scene, geometry)), scene.patches.size());
    for (const auto& [x, n] : points_of_surfaces)
        for (std::uint32_t p = 1; p < scene.patches.size(); ++p) {
            bool lights = false;
            for (const std::uint32_t v : scene.patches[p].vertices) {
                const V3f to_corner = scene.vertices[v] - x;
                lights = lights || (n.dot(to_corner) > 1e-3f && geometry[p].normal().dot(to_corner) < -1e-3f);
            }
            if (lights) {
                EXPECT_GT(tree.probability(p, x, n), 0) << "patch " << p;
            }
        }
}

TEST(LightTree, NeverTakesWhatIsBehindOrFacesAway) {
    Scene scene;
    const std::uint32_t light = add_material(scene, Rgb(0, 0, 0), Rgb(1, 1, 1));
    add_rectangle(scene, V3f(-1, -1, 1), V3f(0, 2, 0), V3f(2, 0, 0), light);  // faces down
    const LightTree one = tree_of(scene);
    EXPECT_EQ(one.choose(V3f(0, 0, 0), V3f(0, 0, 1), 0.5).index, 0u);
    EXPECT_EQ(one.choose(V3f(0, 0, 0), V3f(0, 0, -1), 0.5).index, none) << "behind";
    EXPECT_EQ(one.choose(V3f(0, 0, 9), V3f(0, 0, -1), 0.5).index, none) << "facing away";
    add_rectangle(scene, V3f(-1, -1, -1), V3f(2, 0, 0), V3f(0, 2, 0), light);  // faces up
    const LightTree two = tree_of(scene);
    EXPECT_FLOAT_EQ(two.probability(0, V3f(0, 0, 0), V3f(0, 0, 1)), 1);
    EXPECT_FLOAT_EQ(two.probability(1, V3f(0, 0, 0), V3f(0, 0, -1)), 1);
}

TEST(LightTree, PrefersTheNearAndTheBright) {
    Scene scene;
    const std::uint32_t dim = add_material(scene, Rgb(0, 0, 0), Rgb(1, 1, 1));
    const std::uint32_t bright = add_material(scene, Rgb(0, 0, 0), Rgb(4, 4, 4));
    const auto add_lamp = [&](float x, std::uint32_t material) {
        add_rectangle(scene, V3f(x, 0, 2), V3f(0, 0.1f, 0), V3f(0.1f, 0, 0), material);
    };
    for (const float x : {0.0f, 20.0f, 40.0f}) add_lamp(x, dim);
    add_lamp(-5, dim);
    add_lamp(5, bright);
    const LightTree tree = tree_of(scene);
    const V3f x(0, 0, 0), up(0, 0, 1);
    EXPECT_GT(tree.probability(0, x, up), 0.5f);
    EXPECT_GT(tree.probability(4, x, up), 2 * tree.probability(3, x, up));
    EXPECT_LT(tree.probability(2, x, up), 0.01f);
}

/// 400 lamps that face down, one per room of 5 x 5 m: the lamp above dominates the light on a floor and on a wall.
TEST(LightTree, PrefersTheLampOfTheRoomAmongHundreds) {
    Scene scene;
    const std::uint32_t light = add_material(scene, Rgb(0, 0, 0), Rgb(1, 1, 1));
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 20; ++column)
            add_rectangle(scene, V3f(5.0f * static_cast<float>(column), 5.0f * static_cast<float>(row), 2.7f),
                          V3f(0, 1, 0), V3f(1, 0, 0), light);
    const LightTree tree = tree_of(scene);
    float on_floors = 0, on_walls = 0;
    for (std::uint32_t room = 0; room < 400; ++room) {
        const V3f below = scene.vertices[scene.patches[room].vertices[0]] - V3f(0, 0, 2.7f);
        on_floors += tree.probability(room, below, V3f(0, 0, 1)) / 400;
        on_walls += tree.probability(room, below + V3f(-1.5f, 0, 1), V3f(1, 0, 0)) / 400;
    }
    EXPECT_GT(on_floors, 0.5f) << "with the cosines towards the nodes' centres it is 0.1";
    EXPECT_GT(on_walls, 0.4f);
}

TEST(LightTree, WithoutLightChoosesNothing) {
    Scene scene;
    add_rectangle(scene, V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0),
                  add_material(scene, Rgb(0.5f, 0.5f, 0.5f), Rgb(0, 0, 0)));
    const LightTree tree = tree_of(scene);
    EXPECT_EQ(tree.choose(V3f(0, 0, 0), V3f(0, 0, 1), 0.5).index, none);
    EXPECT_EQ(tree.probability(0, V3f(0, 0, 0), V3f(0, 0, 1)), 0);
}

}  // namespace
}  // namespace interflect
