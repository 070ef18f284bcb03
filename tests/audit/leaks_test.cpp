// Escaping light and one-way light of black boxes against exact form factors: every ray is a Bernoulli trial.
#include "interflect/leaks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "interflect/core.h"
#include "interflect/solve.h"
#include "tests/support/form_factors.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr double traced = 1 << 16;
/// Rejects correct code with probability 6e-7 for rays with a standard deviation of at most 1; the seed is fixed.
const double bound = 5 / std::sqrt(traced);
double bound_of_share(double share) { return bound * std::sqrt(share * (1 - share)); }

const Material black{.name = "black"}, lamp{.name = "lamp", .exitance = Rgb(100)};
const Rectangle floor_square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
Rectangle square_above(double z) { return {{0, 0, z}, {0, 1, 0}, {1, 0, 0}}; }

/// A closed cube of side 1 whose floor alone emits.
Scene lit_cube(int n = 1, const Material& ceiling = black) {
    return closed_box({1, 1, 1}, n, {black, black, black, black, lamp, ceiling});
}

/// Adds a black, one-sided sheet across the cube. @param faces_up  Whether its front is the upper side.
void add_sheet(Scene& scene, float z, bool faces_up) {
    scene.objects.emplace_back("sheet");
    const V3f x(1, 0, 0), y(0, 1, 0);
    const auto sheet = add_rectangle(scene, {0, 0, z}, faces_up ? x : y, faces_up ? y : x, 0);
    scene.patches[sheet].object = static_cast<std::uint32_t>(scene.objects.size() - 1);
}

/// A solution in which no light has arrived, so that only the sources shine.
Solution light_of_sources(const Scene& scene, const RayCaster& ray_caster) {
    Solution solution = solve(scene, ray_caster, {.limits = {.rays = 1000}});
    solution.irradiance.assign(solution.irradiance.size(), Rgb(0));
    return solution;
}

Escapes escapes_of(const Scene& scene) {
    const RayCaster ray_caster(scene);
    return find_escapes(scene, ray_caster, light_of_sources(scene, ray_caster));
}

OneWayLight one_way_light_of(const Scene& scene) {
    const RayCaster ray_caster(scene);
    return find_one_way_light(scene, ray_caster, light_of_sources(scene, ray_caster));
}

TEST(Escapes, AreZeroInAClosedBox) {
    const Escapes escapes = escapes_of(lit_cube());
    EXPECT_EQ(escapes.rays, 1 << 16);
    EXPECT_EQ(escapes.escaped, 0);
    EXPECT_FALSE(escapes.is_leak());
}

TEST(Escapes, AreTheFormFactorOfTheMissingCeiling) {
    Scene scene = lit_cube();
    scene.patches.pop_back();
    const double exact = form_factor(floor_square, square_above(1));
    const Escapes escapes = escapes_of(scene);
    EXPECT_NEAR(escapes.share(), exact, bound_of_share(exact));
    EXPECT_FALSE(escapes.is_leak()) << "an open box is no leak";
}

TEST(Escapes, ThroughSmallHolesAreALeak) {
    constexpr int n = 17;
    constexpr std::size_t ceiling = 5 * n * n;
    Scene scene = lit_cube(n);
    const std::vector<Rectangle> patches = rectangles_of(scene);
    double exact = 0;
    for (const std::size_t hole : {12 * n + 12, 12 * n + 4, 4 * n + 12, 4 * n + 4}) {  // the last one first
        exact += form_factor(floor_square, patches[ceiling + hole]);
        scene.patches.erase(scene.patches.begin() + static_cast<std::ptrdiff_t>(ceiling + hole));
    }
    const Escapes escapes = escapes_of(scene);
    EXPECT_NEAR(escapes.share(), exact, bound_of_share(exact));
    EXPECT_GT(escapes.through_gaps, escapes.escaped / 2);
    EXPECT_TRUE(escapes.is_leak());
}

/// All light of a lamp on the outside escapes. Sources are sampled systematically, so its share of the power is exact.
TEST(Escapes, AreInProportionToPower) {
    Scene scene = lit_cube();
    const std::uint32_t sign = add_material(scene, Rgb(0), Rgb(20));
    add_rectangle(scene, {0, 0, 1.5f}, {2, 0, 0}, {0, 1, 0}, sign);
    constexpr double exact = 2 * 20 / (2 * 20 + 100.0);
    EXPECT_NEAR(escapes_of(scene).share(), exact, 1 / traced);
}

TEST(Escapes, OfADarkSceneAreUnknown) {
    const Escapes escapes = escapes_of(closed_box({1, 1, 1}, 1, {black}));
    EXPECT_EQ(escapes.rays, 0);
    EXPECT_EQ(escapes.share(), 0);
}

TEST(OneWayLight, ThroughASheetIsTheFormFactorOfTheSheet) {
    Scene scene = lit_cube();
    add_sheet(scene, 0.5f, true);
    const double exact = form_factor(floor_square, square_above(0.5));
    const OneWayLight found = one_way_light_of(scene);
    EXPECT_NEAR(found.share, exact, bound_of_share(exact));
    EXPECT_EQ(found.reflected_share, 0);
    EXPECT_EQ(scene.objects[found.object], "sheet");
}

/// The ceiling reflects half of its light once, onto black surfaces above the sheet.
TEST(OneWayLight, IncludesItsReflections) {
    Scene scene = lit_cube(1, {.name = "grey", .reflectance = Rgb(0.5f)});
    add_sheet(scene, 0.5f, true);
    const double reflected = 0.5 * form_factor(floor_square, square_above(1));
    const OneWayLight found = one_way_light_of(scene);
    EXPECT_NEAR(found.reflected_share, reflected, bound_of_share(reflected));
    EXPECT_NEAR(found.share, form_factor(floor_square, square_above(0.5)) + reflected, bound);
}

/// Solid angle of a square of side 1, seen from 1/4 above its centre, over that of the sphere.
TEST(OneWayLight, OfAPointLightIsASolidAngle) {
    Scene scene = closed_box({1, 1, 1}, 1, {black});
    add_sheet(scene, 0.75f, true);
    scene.luminaires.push_back({"bulb", 0, PointLight{{0.5f, 0.5f, 0.5f}, Rgb(100)}});
    constexpr double half = 0.5, distance = 0.25;
    const double exact = 4 * std::asin(half * half / (half * half + distance * distance)) / (4 * std::numbers::pi);
    EXPECT_NEAR(one_way_light_of(scene).share, exact, bound_of_share(exact));
}

struct BoxRay {
    Imath::V3d origin, normal;
};

/// Follows a diffuse ray to its hit in the unit cube.
BoxRay next(const BoxRay& from, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double angle = 2 * std::numbers::pi * uniform(random), u = uniform(random), r = std::sqrt(u);
    const Imath::V3d s(from.normal.z, from.normal.x, from.normal.y), t = from.normal.cross(s);
    const Imath::V3d d = r * std::cos(angle) * s + r * std::sin(angle) * t + std::sqrt(1 - u) * from.normal;
    double nearest = 1e9;
    BoxRay hit;
    for (int axis = 0; axis < 3; ++axis) {
        const double distance = ((d[axis] > 0 ? 1 : 0) - from.origin[axis]) / d[axis];
        if (distance < 1e-9 || distance >= nearest) continue;
        nearest = distance;
        hit = {from.origin + distance * d, Imath::V3d(0)};
        hit.normal[axis] = d[axis] > 0 ? -1 : 1;
    }
    return hit;
}

/// Light of the floor stops at the sheet, though places above it see the floor. It counts where its next ray stays
/// above the sheet. The reference follows 10^6 such walks in the empty cube, with a standard error of 0.05%.
TEST(OneWayLight, IsMissingBehindAFront) {
    constexpr int walks = 1'000'000;
    constexpr double sheet = 0.5;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    int counted = 0;
    for (int i = 0; i < walks; ++i) {
        const BoxRay above = next({{uniform(random), uniform(random), 0}, {0, 0, 1}}, random);
        if (above.origin.z > sheet) counted += next(above, random).origin.z > sheet;
    }
    Scene scene = lit_cube();
    add_sheet(scene, static_cast<float>(sheet), false);
    const double reference = static_cast<double>(counted) / walks;
    const OneWayLight found = one_way_light_of(scene);
    EXPECT_NEAR(found.share, -reference, bound_of_share(reference) * std::sqrt(1 + traced / walks));
    EXPECT_EQ(scene.objects[found.object], "sheet");
}

TEST(OneWayLight, IsZeroForClosedSolidsAndTwoSidedSheets) {
    Scene solid = lit_cube();
    add_box(solid, {0.25f, 0.25f, 0.25f}, {0.75f, 0.75f, 0.75f}, 0);
    EXPECT_EQ(one_way_light_of(solid).share, 0);
    Scene two_sided = lit_cube();
    add_rectangle(two_sided, {0, 0, 0.5f}, {1, 0, 0}, {0, 1, 0}, 0, 1, 1, true);
    EXPECT_EQ(one_way_light_of(two_sided).share, 0);
}

TEST(Leaks, OfAnotherSceneAreRefused) {
    const Scene scene = lit_cube(), other = lit_cube(2);
    const RayCaster ray_caster(scene), other_caster(other);
    const Solution solution = light_of_sources(scene, ray_caster);
    EXPECT_THROW(find_escapes(scene, other_caster, solution), InputError);
    EXPECT_THROW(find_escapes(other, other_caster, solution), InputError);
    EXPECT_THROW(find_one_way_light(scene, other_caster, solution), InputError);
    EXPECT_THROW(find_one_way_light(other, other_caster, solution), InputError);
}

}  // namespace
}  // namespace interflect
