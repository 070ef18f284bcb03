// View factors against closed forms: Howell's catalogue C-11 (parallel rectangles), C-14 (perpendicular ones), C-41
// (coaxial discs) and C-13/C-15 (form_factors.h).
//
// Each statistical test compares independent seeds by a t test at `false_alarm`.
//
// Seen to fail if directions lack the cosine, patches of a group are chosen regardless of area, starts on covered parts
// are kept, covered area is counted, sky and ground are swapped, all replicates share a scrambling, the seed is
// ignored, errors belong to one replicate, backs are transparent, or backs have priority over faces.

#include "interflect/view_factors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "tests/support/form_factors.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;
using testing::Each;
using testing::HasSubstr;

constexpr std::uint64_t seeds = 16;

const Material black{.name = "black"};

Scene empty_scene() {
    Scene scene;
    scene.objects = {""};
    scene.materials[add_material(scene, Rgb(0), Rgb(0))].name = "black";
    return scene;
}

/// Mean of the rows' numbers over the seeds, tested by p-value.
template <class Value>
double p_value(const Scene& scene, const std::vector<FaceGroup>& groups, std::int64_t rays, double expected,
               const Value& value) {
    const RayCaster ray_caster(scene);
    std::vector<double> samples;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        samples.push_back(value(view_factors(scene, ray_caster, groups, {rays, seed})));
    return t_test(samples, expected);
}

Scene opposite_squares() {
    Scene scene = empty_scene();
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    add_rectangle(scene, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0);
    return scene;
}

TEST(ViewFactors, OfOppositeSquaresHaveTheCataloguesFigure) {
    const Scene scene = opposite_squares();
    EXPECT_GT(p_value(scene, facet_groups(scene), 1 << 16, 0.199825,
                      [](const ViewFactors& f) { return f.factor(0, 1).value; }),
              false_alarm);
}

TEST(ViewFactors, OfPerpendicularSquaresHaveTheCataloguesFigure) {
    Scene scene = empty_scene();
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    add_rectangle(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0);
    EXPECT_GT(p_value(scene, facet_groups(scene), 1 << 16, 0.200044,
                      [](const ViewFactors& f) { return f.factor(0, 1).value; }),
              false_alarm);
}

/// Adds a regular polygon about the z axis, as triangles from its centre, that faces up or down.
void add_disc(Scene& scene, float radius, float z, int sides, bool faces_up, std::uint32_t object) {
    const auto corner = [&](int k) {
        const double turn = 2 * std::numbers::pi * (k % sides) / sides;
        return V3f(Imath::V3d(radius * std::cos(turn), radius * std::sin(turn), z));
    };
    for (int k = 0; k < sides; ++k) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (const V3f& x : {V3f(0, 0, z), corner(faces_up ? k : k + 1), corner(faces_up ? k + 1 : k)})
            scene.vertices.push_back(x);
        scene.patches.push_back({{first, first + 1, first + 2, none}, 0, no_patch, object, none});
    }
}

TEST(ViewFactors, OfCoaxialDiscsHaveTheCataloguesFigure) {
    // Radii 1 and 2 at distance 1. A polygon of 256 sides has 1 - 1e-4 of the area of its circle. The polygons have the
    // radius of equal area, which leaves errors of the order of 1 / 256^4.
    constexpr int sides = 256;
    const double turn = 2 * std::numbers::pi / sides;
    const auto scale = static_cast<float>(std::sqrt(turn / std::sin(turn)));
    Scene scene = empty_scene();
    scene.objects = {"", "small", "large"};
    add_disc(scene, scale, 0, sides, true, 1);
    add_disc(scene, 2 * scale, 1, sides, false, 2);
    const double a = 1 + (1 + 2.0 * 2) / (1 * 1), expected = (a - std::sqrt(a * a - 4 * 4.0)) / 2;
    EXPECT_GT(p_value(scene, object_groups(scene), 1 << 16, expected,
                      [](const ViewFactors& f) { return f.factor(0, 1).value; }),
              false_alarm);
    const ViewFactors f = view_factors(scene, RayCaster(scene), object_groups(scene), {1 << 16});
    EXPECT_NEAR(f.areas[0], std::numbers::pi, 1e-5);
}

TEST(ViewFactors, OfAClosedBoxAreTheClosedForms) {
    const Scene scene = closed_box({2, 3, 1}, 2, {black});
    const FormFactors exact = exact_form_factors(scene);
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> samples(scene.patches.size() * scene.patches.size());
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const ViewFactors f = view_factors(scene, ray_caster, facet_groups(scene), {std::int64_t{24} << 12, seed});
        for (std::size_t i = 0; i < f.size(); ++i)
            for (std::size_t j = 0; j < f.size(); ++j) samples[i * f.size() + j].push_back(f.factor(i, j).value);
    }
    std::vector<double> p_values;
    for (std::size_t i = 0; i < exact.patches(); ++i)
        for (std::size_t j = 0; j < exact.patches(); ++j)
            p_values.push_back(t_test(samples[i * exact.patches() + j], exact(i, j)));
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

/// The unit cube with a square of half the width in the middle, as an obstruction without a group.
TEST(ViewFactors, OfACubeWithAnObstructionCountItAsBlocked) {
    Scene scene = closed_box({1, 1, 1}, 1, {black});
    scene.objects = {""};
    const std::vector<FaceGroup> walls = facet_groups(scene);
    add_rectangle(scene, {0.25f, 0.25f, 0.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 0, 1, 1, true);
    // By reciprocity from the square of 1/4 m^2 to the floor, the wall 4: Howell C-13 for parallel rectangles.
    const double to_floor =
        form_factor({{0.25, 0.25, 0.5}, {0, 0.5, 0}, {0.5, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_GT(p_value(scene, walls, 6 << 14, to_floor / 4, [](const ViewFactors& f) { return f.blocked[4]; }),
              false_alarm);
    const ViewFactors f = view_factors(scene, RayCaster(scene), walls, {6 << 14});
    for (std::size_t i = 0; i < f.size(); ++i) {
        EXPECT_NEAR(f.closure(i), 1, 1e-6);
        EXPECT_EQ(f.sky[i] + f.ground[i], 0) << "closed";
    }
}

TEST(ViewFactors, OfOneSidedFacesAreReciprocalWithOpaqueBacks) {
    // A one-sided face between the opposite squares, which faces the lower one.
    Scene scene = opposite_squares();
    add_rectangle(scene, {0.25f, 0.25f, 0.5f}, {0, 0.5f, 0}, {0.5f, 0, 0}, 0);
    const ViewFactors open = view_factors(scene, RayCaster(scene), facet_groups(scene), {3 << 14});
    EXPECT_GT(open.factor(1, 0).value, open.factor(0, 1).value + 0.03);
    const ViewFactors f = view_factors(scene, facet_groups(scene), {3 << 14});
    EXPECT_EQ(f.size(), 3u);
    EXPECT_GT(f.blocked[1], 0.03);
    EXPECT_LT(consistency(f).reciprocity.largest_in_errors, 5);
}

TEST(ViewFactors, OfAThinPartitionAreThoseOfItsTwoSides) {
    // Two one-sided faces in one plane between opposite squares; the upper one is smaller.
    Scene scene = opposite_squares();
    add_rectangle(scene, {0.25f, 0.25f, 0.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 0);
    add_rectangle(scene, {0, 0, 0.5f}, {0, 1, 0}, {1, 0, 0}, 0);
    const ViewFactors f = view_factors(scene, facet_groups(scene), {4 << 14});
    EXPECT_NEAR(f.areas[2], 0.25, 1e-6);
    EXPECT_NEAR(f.areas[3], 1, 1e-6) << "backs cover no face";
    EXPECT_GT(p_value(with_opaque_backs(scene), facet_groups(scene), 4 << 12,
                      form_factor({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}}),
                      [](const ViewFactors& g) { return g.factor(0, 3).value; }),
              false_alarm);
    EXPECT_EQ(f.factor(0, 1).value, 0);
    EXPECT_GT(f.factor(1, 2).value, 0.1);
    EXPECT_GT(f.blocked[1], 0.1);
}

TEST(ViewFactors, OfAnOpenBoxSeeTheSkyThroughItsOpening) {
    Scene scene = closed_box({2, 3, 1}, 1, {black});
    scene.objects = {""};
    scene.patches.pop_back();  // the ceiling
    const double opening = form_factor({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{0, 0, 1}, {0, 3, 0}, {2, 0, 0}});
    EXPECT_GT(p_value(scene, facet_groups(scene), 5 << 14, opening, [](const ViewFactors& f) { return f.sky[4]; }),
              false_alarm);
}

TEST(ViewFactors, CountTheSkyAboveTheHorizonAndTheGroundBelow) {
    // Half of the radiation of a single wall goes down.
    Scene scene = empty_scene();
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0);
    EXPECT_GT(p_value(scene, facet_groups(scene), 1 << 14, 0.5, [](const ViewFactors& f) { return f.sky[0]; }),
              false_alarm);
    const ViewFactors f = view_factors(scene, RayCaster(scene), facet_groups(scene), {1 << 14});
    EXPECT_FLOAT_EQ(f.sky[0] + f.ground[0], 1);
    EXPECT_TRUE(f.values.empty());
}

TEST(ViewFactors, AreForTheUncoveredAreaAlone) {
    // A sheet covers three quarters of the lower square. The quarter at the border sees less of the upper square.
    Scene scene = opposite_squares();
    const std::vector<FaceGroup> squares = facet_groups(scene);
    add_rectangle(scene, {0, 0, 0}, {0.75f, 0, 0}, {0, 1, 0}, 0);
    const ViewFactors f = view_factors(scene, RayCaster(scene), squares, {1 << 14});
    EXPECT_NEAR(f.areas[0], 0.25, 1e-6);
    const double expected = form_factor({{0.75, 0, 0}, {0.25, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}});
    EXPECT_LT(expected, 0.19) << "0.2 for the whole square";
    EXPECT_GT(p_value(scene, squares, 1 << 16, expected, [](const ViewFactors& g) { return g.factor(0, 1).value; }),
              false_alarm);
    EXPECT_GT(p_value(scene, squares, 1 << 16, expected / 4, [](const ViewFactors& g) { return g.factor(1, 0).value; }),
              false_alarm);
}

TEST(ViewFactors, OfACoveredGroupAreEmpty) {
    Scene scene = opposite_squares();
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    const ViewFactors f = view_factors(scene, RayCaster(scene), facet_groups(scene), {1 << 12});
    EXPECT_EQ(f.areas[2] * f.areas[0], 0) << "of two equal faces, one covers the other";
    const std::size_t covered = f.areas[0] == 0 ? 0 : 2;
    EXPECT_EQ(f.row_offsets[covered], f.row_offsets[covered + 1]);
    EXPECT_EQ(f.closure(covered), 0);
}

TEST(ViewFactors, OfUnevenPatchesOfOneGroupWeightThemByArea) {
    // The lower square in strips of widths 1/64, 47/64 and 16/64 as one group.
    Scene scene = empty_scene();
    scene.objects = {"", "low", "high"};
    for (const auto& [from, to] : {std::pair{0.0f, 1.0f}, {1.0f, 48.0f}, {48.0f, 64.0f}})
        add_rectangle(scene, {from / 64, 0, 0}, {(to - from) / 64, 0, 0}, {0, 1, 0}, 0);
    for (Patch& p : scene.patches) p.object = 1;
    scene.patches[add_rectangle(scene, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0)].object = 2;
    EXPECT_GT(p_value(scene, object_groups(scene), 1 << 16, 0.199825,
                      [](const ViewFactors& f) { return f.factor(0, 1).value; }),
              false_alarm);
}

TEST(ViewFactors, HaveTheirStandardErrors) {
    // z = (F - exact) / error over all pairs of a box and 64 seeds. With 31 degrees of freedom, the mean of z^2 is
    // 31/29 = 1.07, and |z| > 3 has a probability of 0.5%. The errors are slightly too large for few hits.
    const Scene scene = closed_box({2, 3, 1}, 2, {black});
    const FormFactors exact = exact_form_factors(scene);
    const RayCaster ray_caster(scene);
    double squares = 0, pairs = 0, beyond = 0;
    for (std::uint64_t seed = 100; seed < 164; ++seed) {
        const ViewFactors f = view_factors(scene, ray_caster, facet_groups(scene), {std::int64_t{24} << 12, seed});
        for (std::size_t i = 0; i < f.size(); ++i)
            for (std::size_t j = 0; j < f.size(); ++j) {
                if (exact(i, j) == 0) continue;
                const auto [value, error] = f.factor(i, j);
                const double z = (value - exact(i, j)) / error;
                squares += z * z;
                beyond += std::abs(z) > 3;
                ++pairs;
            }
    }
    EXPECT_GT(squares / pairs, 0.9);
    EXPECT_LT(squares / pairs, 1.2);
    EXPECT_LT(beyond / pairs, 0.01);
}

TEST(ViewFactors, DependOnTheSeedAlone) {
    const Scene scene = closed_box({1, 1, 1}, 3, {black});
    const RayCaster ray_caster(scene);
    const auto estimate = [&](std::uint64_t seed) {
        return view_factors(scene, ray_caster, facet_groups(scene), {1 << 17, seed});
    };
    const ViewFactors a = estimate(1), b = estimate(1), c = estimate(2);
    EXPECT_EQ(a.columns, b.columns);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(a.errors, b.errors);
    EXPECT_NE(a.values, c.values);
}

std::string fault_of_groups(const std::vector<FaceGroup>& groups, std::int64_t rays = 1024) {
    const Scene scene = opposite_squares();
    try {
        view_factors(scene, RayCaster(scene), groups, {rays});
    } catch (const InputError& e) {
        return e.what();
    }
    return "no fault";
}

TEST(ViewFactors, RefuseFaultyGroups) {
    EXPECT_THAT(fault_of_groups({{"a", {PatchIndex(0)}}, {"b", {PatchIndex(1), PatchIndex(0)}}}),
                HasSubstr("patch 0 belongs to the groups 'a' and 'b'"));
    EXPECT_THAT(fault_of_groups({{"a", {PatchIndex(0), PatchIndex(0)}}}),
                HasSubstr("patch 0 belongs to the groups 'a' and 'a'"));
    EXPECT_THAT(fault_of_groups({{"a", {PatchIndex(2)}}}), HasSubstr("group 'a' has patch 2; the scene has 2 patches"));
    EXPECT_THAT(fault_of_groups({}), HasSubstr("expected at least one group of faces"));
    EXPECT_THAT(fault_of_groups({{"a", {PatchIndex(0)}}}, 0), HasSubstr("rays: expected a positive number, found 0"));
}

TEST(ViewFactors, StopOnRequest) {
    const Scene scene = opposite_squares();
    const std::atomic<bool> stop = true;
    Monitor monitor;
    monitor.stop = &stop;
    EXPECT_THROW(view_factors(scene, RayCaster(scene), facet_groups(scene), {}, monitor), Stopped);
}

}  // namespace
}  // namespace interflect
