#include "interflect/render/smooth/element_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/smooth_field.h"
#include "interflect/render/smooth/vertex_values.h"
#include "tests/render/power_of_field.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;
using testing_support::powers;

const Rgb vertex_black(0, 0, 0), vertex_grey(0.5f, 0.5f, 0.5f), dark(0.1f, 0.2f, 0.3f), bright(4, 5, 6);
constexpr std::size_t plenty = 1 << 16;  // elements

void expect_near(const Rgb& found, const Rgb& expected, float tolerance = 1e-5f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance);
}

/// Patches of every kind in the plane z = 0: 3 x 3 irregular quadrilaterals, half of them cut into two triangles. The
/// first vertex varies, so that edges of all numbers meet.
Scene mixed_mesh() {
    constexpr std::uint32_t n = 3;
    Scene scene;
    add_material(scene, vertex_grey, vertex_black);
    const auto shift = [&] { return 0.4f * static_cast<float>(random_double(1, scene.vertices.size()) - 0.5); };
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float moved = shift();
            scene.vertices.emplace_back(static_cast<float>(x) + moved, static_cast<float>(y) - 0.7f * moved, 0.0f);
        }
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t low = i / n * (n + 1) + i % n, high = low + n + 1;
        std::array<std::uint32_t, 4> v{low, low + 1, high + 1, high};
        std::rotate(v.begin(), v.begin() + i / 2 % 4, v.end());
        if (i % 2) {
            scene.patches.push_back({.vertices = v});
        } else {
            scene.patches.push_back({.vertices = {v[0], v[1], v[2], none}});
            scene.patches.push_back({.vertices = {v[3], v[0], v[2], none}});
        }
    }
    return scene;
}

/// Neighbours can differ in level by any amount.
void refine_at_random(ElementForest& forest, int deepest, std::uint64_t seed) {
    for (ElementIndex e{0}; e < forest.size(); ++e)
        if (forest.level(e) < deepest && random_double(seed, e) < 0.5) forest.subdivide(e);
}

void refine_evenly(ElementForest& forest, int deepest) {
    for (ElementIndex e{0}; e < forest.size(); ++e)
        if (forest.level(e) < deepest) forest.subdivide(e);
}

std::vector<Rgb> random_values(const ElementForest& forest, std::uint64_t seed) {
    std::vector<Rgb> values;
    for (ElementIndex e{0}; e < forest.size(); ++e)
        values.push_back(Rgb(1, 1, 1) * static_cast<float>(random_double(seed, e)));
    return values;
}

template <class ValueOf>
std::vector<Rgb> values_of(const ElementForest& forest, const ValueOf& value_of) {
    std::vector<Rgb> values;
    for (ElementIndex e{0}; e < forest.size(); ++e) values.push_back(value_of(e));
    return values;
}

/// Returns corners in the order of ElementVertices [m].
std::vector<V3f> corner_points(const ElementForest& forest, ElementIndex e) {
    const PatchGeometry& patch = forest.geometry(forest.patch(e));
    const Cell cell = forest.cell(e);
    if (patch.is_triangle())
        return {patch.point(cell.at(0, 0)), patch.point(cell.at(1, 0)), patch.point(cell.at(0, 1))};
    return {patch.point(cell.at(0, 0)), patch.point(cell.at(1, 0)), patch.point(cell.at(1, 1)),
            patch.point(cell.at(0, 1))};
}

std::optional<Rgb> value_at(const ElementForest& forest, const SmoothField& field, const V3f& x) {
    for (PatchIndex p{0}; p < forest.patch_count(); ++p) {
        const Parameters parameters = forest.geometry(p).parameters_of(x);
        if ((forest.geometry(p).point(parameters) - x).length() < 1e-6f) return field.at(p, parameters);
    }
    return std::nullopt;
}

/// Computes the largest difference across the edges of leaves, between points at `distance` [m] from the edge.
float largest_jump(const ElementForest& forest, const SmoothField& field, float distance) {
    float largest = 0;
    for (const ElementIndex leaf : forest.leaves()) {
        const std::vector<V3f> corners = corner_points(forest, leaf);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const V3f along = corners[(c + 1) % corners.size()] - corners[c];
            const V3f across = V3f(0, 0, distance).cross(along.normalized());
            for (const float t : {0.07f, 0.24f, 0.26f, 0.47f, 0.55f, 0.7f, 0.98f}) {
                const V3f x = corners[c] + t * along;
                const auto here = value_at(forest, field, x + across), there = value_at(forest, field, x - across);
                if (here && there) largest = std::max(largest, std::abs(here->x - there->x));
            }
        }
    }
    return largest;
}

/// Values are in [0, 1] and the lowest leaf is about 0.4 / 2^5 m high, so slopes stay below about 2 / 0.0125 = 160 per
/// metre. Continuity depends on the constraint of hanging vertices (the last loop of Joins::apply()).
TEST(SmoothField, IsContinuousWhateverTheLevels) {
    const Scene scene = mixed_mesh();
    for (const std::uint64_t seed : {1, 2, 3}) {
        ElementForest forest(scene, plenty);
        refine_at_random(forest, 5, seed);
        const ElementVertices vertices(scene, forest);
        const SmoothField field(forest, vertices, random_values(forest, seed));
        EXPECT_GT(vertices.hanging().size(), 100u);
        for (const float distance : {1e-4f, 1e-5f})
            EXPECT_LT(largest_jump(forest, field, distance), 2 * distance * 160 + 1e-4f) << distance;
    }
}

/// Two squares; only the right one is divided, and its quarters are bright. The values at both ends of their common
/// edge are means of dark and bright. The integral of an end's basis function is a quarter of the left square, and an
/// eighth of the right one: half of it by the hanging vertex in the middle, which must have the same value.
TEST(SmoothField, AHangingVertexLiesOnTheLargeLeafsEdge) {
    Scene scene;
    add_rectangle(scene, V3f(0, 0, 0), V3f(2, 0, 0), V3f(0, 1, 0), add_material(scene, vertex_grey, vertex_black), 2,
                  1);
    ElementForest forest(scene, plenty);
    forest.subdivide(ElementIndex(1));
    const ElementVertices vertices(scene, forest);
    ASSERT_EQ(vertices.hanging().size(), 1u);
    const SmoothField field(forest, vertices, {std::vector{dark, bright, bright, bright, bright, bright}});
    for (const float t : {0.0f, 0.3f, 0.5f, 0.9f, 1.0f}) {
        expect_near(field.at(PatchIndex(0), {1, t}), (dark * 2 + bright) / 3);
        expect_near(field.at(PatchIndex(1), {0, t}), (dark * 2 + bright) / 3);
    }
}

/// At the common corner of the quarters of an irregular quadrilateral, each quarter is weighted by the integral of the
/// bilinear basis function, here by the midpoint rule (relative error below 1e-4).
TEST(VertexValues, AreWeightedByIntegrals) {
    Scene scene;
    add_material(scene, vertex_grey, vertex_black);
    scene.vertices = {V3f(0, 0, 0), V3f(4, 0.5f, 0), V3f(3, 2, 0), V3f(-1, 3, 0)};
    scene.patches = {{.vertices = {0, 1, 2, 3}}};
    ElementForest forest(scene, plenty);
    forest.subdivide(ElementIndex(0));
    const ElementVertices vertices(scene, forest);
    const std::uint32_t centre = vertices.corners(ElementIndex(1))[2];
    std::array<double, 4> integral{};
    double sum = 0;
    constexpr int steps = 100;
    for (std::uint32_t k = 0; k < 4; ++k)
        for (int i = 0; i < steps * steps; ++i) {
            const float s = (static_cast<float>(i % steps) + 0.5f) / steps,
                        t = (static_cast<float>(i / steps) + 0.5f) / steps;
            const Parameters x = forest.cell(ElementIndex(1 + k)).at(s, t);
            const float basis = (1 - std::abs(2 * x.u - 1)) * (1 - std::abs(2 * x.v - 1));
            integral[k] += basis * forest.geometry(PatchIndex(0)).jacobian(x);
            sum += basis * forest.geometry(PatchIndex(0)).jacobian(x);
        }
    for (std::uint32_t k = 0; k < 4; ++k) {
        std::vector<Rgb> values(5, vertex_black);
        values[1 + k] = bright;
        const auto share = static_cast<float>(integral[k] / sum);
        expect_near(vertex_values(forest, vertices, values)[centre], bright * share, 6e-4f);
    }
}

/// All leaves belong to one smooth surface. Seen to fail with equal weights of all corners.
TEST(VertexValues, KeepThePower) {
    const Scene scene = mixed_mesh();
    for (const std::uint64_t seed : {1, 2, 3}) {
        ElementForest forest(scene, plenty);
        refine_at_random(forest, 5, seed);
        std::vector<Rgb> values;
        for (ElementIndex e{0}; e < forest.size(); ++e)
            values.emplace_back(static_cast<float>(std::pow(random_double(seed + 3, e), 4)));
        const auto [power, of_field] = powers(forest, ElementVertices(scene, forest), values);
        EXPECT_NEAR(of_field, power, 1e-5 * power);
    }
}

/// Pictures of groups of lights sum to the picture of all.
TEST(VertexValues, AreLinear) {
    const Scene scene = mixed_mesh();
    ElementForest forest(scene, plenty);
    refine_at_random(forest, 5, 1);
    const ElementVertices vertices(scene, forest);
    const std::vector<Rgb> a = random_values(forest, 1), b = random_values(forest, 2);
    const std::vector<Rgb> both = values_of(forest, [&](ElementIndex e) { return a[e] + b[e]; });
    const std::vector<Rgb> of_a = vertex_values(forest, vertices, a), of_b = vertex_values(forest, vertices, b),
                           of_both = vertex_values(forest, vertices, both);
    for (std::size_t v = 0; v < of_both.size(); ++v) expect_near(of_both[v], of_a[v] + of_b[v], 1e-6f);
}

using Point = std::tuple<long, long, long>;
Point rounded(const V3f& x) {  // to 0.1 mm
    return {std::lround(1e4f * x.x), std::lround(1e4f * x.y), std::lround(1e4f * x.z)};
}

/// In a flat scene of one material, points and vertices correspond one to one.
TEST(ElementVertices, AreThePointsWhereElementsMeet) {
    const Scene scene = mixed_mesh();
    ElementForest forest(scene, plenty);
    refine_at_random(forest, 5, 4);
    const ElementVertices vertices(scene, forest);
    std::map<Point, std::uint32_t> vertex_at;
    std::vector<V3f> position(vertices.count());
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        const std::vector<V3f> corners = corner_points(forest, e);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::uint32_t vertex = vertices.corners(e)[c];
            ASSERT_EQ(vertex_at.try_emplace(rounded(corners[c]), vertex).first->second, vertex);
            position[vertex] = corners[c];
        }
        EXPECT_EQ(vertices.corners(e)[3] == none, corners.size() == 3);
    }
    EXPECT_EQ(vertex_at.size(), vertices.count());
    for (const auto& [vertex, ends, fraction] : vertices.hanging()) {
        EXPECT_LT((position[vertex] - (position[ends[0]] + position[ends[1]]) / 2).length(), 1e-5f);
        EXPECT_LT(std::max(ends[0], ends[1]), vertex);
    }
}

Rgb linear_field(const V3f& x) { return Rgb(1, 2, 3) + Rgb(4, 0, 1) * x.x + Rgb(0, 5, 2) * x.y; }

/// The leaves of a square and of its two halves, all divided equally, behave like a fine grid of patches.
TEST(SmoothField, ReproducesALinearFieldInsideAnEvenMesh) {
    Scene square;
    add_rectangle(square, V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), add_material(square, vertex_grey, vertex_black));
    Scene halves = square;
    const auto v = square.patches[0].vertices;
    halves.patches = {{.vertices = {v[0], v[1], v[2], none}}, {.vertices = {v[2], v[3], v[0], none}}};
    for (const Scene& scene : {square, halves}) {
        ElementForest forest(scene, plenty);
        refine_evenly(forest, 3);
        const ElementVertices vertices(scene, forest);
        EXPECT_EQ(vertices.count(), 9 * 9u);
        EXPECT_TRUE(vertices.hanging().empty());
        const SmoothField field(forest, vertices, values_of(forest, [&](ElementIndex e) {
                                    const PatchGeometry& patch = forest.geometry(forest.patch(e));
                                    return linear_field(patch.point(forest.cell(e).centre(patch.is_triangle())));
                                }));
        for (float x = 0.125f; x < 0.876f; x += 0.05f)  // excludes leaves at the border
            for (float y = 0.125f; y < 0.876f; y += 0.07f) {
                const auto value = value_at(forest, field, V3f(x, y, 0));
                ASSERT_TRUE(value);
                expect_near(*value, linear_field(V3f(x, y, 0)));
            }
    }
}

/// A dark and a bright square, cut to different depths, side by side at x = 0; the second is turned up by `degrees`.
struct Neighbours {
    Scene scene;
    std::optional<ElementForest> forest;
    std::vector<Rgb> values;

    Neighbours(float degrees, bool same_material) {
        const float angle = degrees * std::numbers::pi_v<float> / 180;
        const std::uint32_t first = add_material(scene, vertex_grey, vertex_black);
        const std::uint32_t second = same_material ? first : add_material(scene, vertex_grey, vertex_black);
        add_rectangle(scene, V3f(-1, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), first);
        add_rectangle(scene, V3f(0, 0, 0), V3f(std::cos(angle), 0, std::sin(angle)), V3f(0, 1, 0), second);
        forest.emplace(scene, plenty);
        refine_at_random(*forest, 4, 9);
        values = values_of(*forest, [&](ElementIndex e) { return forest->patch(e) == 0 ? dark : bright; });
    }
};

TEST(SmoothField, GoesOverARoundedEdge) {
    const Neighbours flat(0, true), rounded_edge(20, true);
    for (const Neighbours* scene : {&flat, &rounded_edge}) {
        const ElementVertices vertices(scene->scene, *scene->forest);
        const SmoothField field(*scene->forest, vertices, scene->values);
        for (float t = 0; t <= 1; t += 0.01f)
            expect_near(field.at(PatchIndex(0), {1, t}), field.at(PatchIndex(1), {0, t}));
        EXPECT_GT(field.at(PatchIndex(0), {1, 0}).x, dark.x + 0.5f);
    }
}

TEST(SmoothField, EndsAtCreasesAndBordersOfMaterials) {
    const Neighbours crease(90, true), border(0, false);
    for (const Neighbours* scene : {&crease, &border}) {
        const ElementVertices vertices(scene->scene, *scene->forest);
        const SmoothField field(*scene->forest, vertices, scene->values);
        for (float t = 0; t <= 1; t += 0.01f) {
            expect_near(field.at(PatchIndex(0), {1, t}), dark);
            expect_near(field.at(PatchIndex(1), {0, t}), bright);
        }
    }
}

/// A hipped roof of 20 degrees: its slopes form a crease at the ridge but join smoothly around both ends of the ridge.
/// The slopes share the vertices at the ends, but no vertex in between.
TEST(SmoothField, ACreaseWhoseEndsAreSmoothIsStillACrease) {
    const float slope = std::tan(20 * std::numbers::pi_v<float> / 180), x = 0.5f * std::numbers::sqrt3_v<float>;
    const float z = -slope * x;
    Scene roof;
    add_material(roof, vertex_grey, vertex_black);
    roof.vertices = {V3f(0, 0, 0),     V3f(0, 1, 0),    V3f(-x, 1.5f, z), V3f(-x, -0.5f, z),
                     V3f(x, -0.5f, z), V3f(x, 1.5f, z), V3f(0, -1, z),    V3f(0, 2, z)};
    roof.patches = {{.vertices = {0, 1, 2, 3}},    {.vertices = {1, 0, 4, 5}},    {.vertices = {0, 3, 6, none}},
                    {.vertices = {0, 6, 4, none}}, {.vertices = {1, 5, 7, none}}, {.vertices = {1, 7, 2, none}}};
    ElementForest forest(roof, plenty);
    forest.subdivide(ElementIndex(0));
    forest.subdivide(ElementIndex(1));
    const ElementVertices vertices(roof, forest);
    const SmoothField field(forest, vertices,
                            values_of(forest, [&](ElementIndex e) { return forest.patch(e) == 0 ? dark : bright; }));
    expect_near(field.at(PatchIndex(0), {0, 0}), field.at(PatchIndex(1), {1, 0}));
    expect_near(field.at(PatchIndex(0), {0.5f, 0}), dark);
    expect_near(field.at(PatchIndex(1), {0.5f, 0}), bright);
}

TEST(SmoothField, TakesNothingFromElementsThatAreCut) {
    const Scene scene = mixed_mesh();
    ElementForest forest(scene, plenty);
    refine_at_random(forest, 3, 5);
    const ElementVertices vertices(scene, forest);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const SmoothField field(forest, vertices, values_of(forest, [&](ElementIndex e) {
                                return forest.is_leaf(e) ? dark : Rgb(nan, nan, nan);
                            }));
    for (PatchIndex p{0}; p < forest.patch_count(); ++p) expect_near(field.at(p, {0.3f, 0.4f}), dark);
}

TEST(SmoothField, RefusesAWrongNumberOfValues) {
    const Scene scene = mixed_mesh();
    const ElementForest forest(scene, plenty);
    const ElementVertices vertices(scene, forest);
    EXPECT_THROW(SmoothField(forest, vertices, std::vector{bright}), InputError);
}

}  // namespace
}  // namespace interflect
