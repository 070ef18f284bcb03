// Form factors from ray counts against Howell's closed forms. Before that, the closed forms against published figures,
// and the independent ray tracer of tests/support against the closed forms.
//
// Seen to fail (scripts/mutation-test) if a payload lacks q, rays are allocated uniformly, 0.5% of the power is lost,
// directions lack the cosine, origins cluster near the centre, or the seed is ignored.

#include "tests/support/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/solver/transport/transport.h"
#include "tests/support/brute_force.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

struct Pair {
    const char* name;
    Rectangle from, to;
    double form_factor;  // from catalogues and textbooks
};
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

const Pair parallel_squares{"parallel", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, 0.199825};
const Pair perpendicular_squares{
    "perpendicular", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.200044};

/// Returns a scene of two squares, each lit on one side; `from` is patch 0.
Scene scene_of(const Pair& pair) {
    Scene scene;
    add_material(scene, {0, 0, 0}, {1, 1, 1});
    for (const Rectangle& r : {pair.from, pair.to}) add_rectangle(scene, V3f(r.corner), V3f(r.u), V3f(r.v), 0);
    return scene;
}

class TwoSquares : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(All, TwoSquares, testing::Values(parallel_squares, perpendicular_squares),
                         testing::PrintToStringParamName());

TEST_P(TwoSquares, ClosedFormIsTheCataloguesFigure) {
    const auto& [name, from, to, expected] = GetParam();
    EXPECT_NEAR(form_factor(from, to), expected, 5e-7);
    EXPECT_NEAR(form_factor(to, from), expected, 5e-7);
}

/// Returns the power received by patch 1 per lumen from patch 0: an estimate of the form factor.
double received_share(const Pair& pair, PointSet set, std::uint64_t seed, std::int64_t rays) {
    const Scene scene = scene_of(pair);
    ElementForest forest(scene, 2);
    SampleStreams streams(set, seed);
    const Materials materials(scene);
    const std::vector<Rgb> darkness(2, Rgb(0));
    TransportStep step;  // the squares have 1 m^2, so power and radiosity are equal
    step.q = {1, 0};
    step.rays = rays;
    step.light = Radiosity(materials, darkness);
    return transport(materials, forest, RayCaster(scene), step, streams).irradiance[1].x;
}

TEST_P(TwoSquares, RandomRaysHitWithTheFormFactorsProbability) {
    constexpr std::int64_t rays = 2'000'000;
    const double exact = form_factor(GetParam().from, GetParam().to);
    const double share = received_share(GetParam(), PointSet::random, 1, rays);
    const auto hits = std::llround(share * rays);
    EXPECT_NEAR(share * rays, static_cast<double>(hits), 0.05) << "each ray carries 1 / N";
    EXPECT_GT(binomial_test(hits, rays, exact), false_alarm);
    EXPECT_LT(binomial_test(hits, rays, 1.01 * exact), false_alarm) << "would notice one percent";
}

TEST_P(TwoSquares, SobolRaysAreUnbiasedAndFarLessNoisy) {
    constexpr std::int64_t rays = 1 << 14;
    const double exact = form_factor(GetParam().from, GetParam().to);
    std::vector<double> shares;
    double squares = 0;
    for (std::uint64_t seed = 1; seed <= 64; ++seed) {
        shares.push_back(received_share(GetParam(), PointSet::sobol, seed, rays));
        squares += (shares.back() - exact) * (shares.back() - exact);
    }
    EXPECT_GT(t_test(shares, exact), false_alarm);
    EXPECT_LT(t_test(shares, 1.01 * exact), false_alarm) << "would notice one percent";
    const double binomial_sigma = std::sqrt(exact * (1 - exact) / rays);
    EXPECT_LT(std::sqrt(squares / 64), 0.3 * binomial_sigma);  // a quarter over many more seeds
}

TEST(ExactFormFactors, SumToOneInAClosedBoxAndAreReciprocal) {
    const Scene scene = colourful_box();
    const std::vector<Rectangle> rectangles = rectangles_of(scene);
    const FormFactors f = exact_form_factors(scene);
    for (std::size_t i = 0; i < f.patches(); ++i) {
        EXPECT_NEAR(f.row_sum(i), 1, 1e-9);
        for (std::size_t j = 0; j < f.patches(); ++j)
            ASSERT_NEAR(rectangles[i].area() * f(i, j), rectangles[j].area() * f(j, i), 1e-12);
    }
}

TEST(ExactFormFactors, AreZeroFromBehind) {
    const auto& [name, from, to, expected] = parallel_squares;
    const Rectangle turned{to.corner, to.v, to.u};
    EXPECT_EQ(form_factor(from, turned), 0);
    EXPECT_EQ(form_factor(turned, from), 0);
}

TEST(TracedFormFactors, AgreeWithTheExactOnes) {
    constexpr std::int64_t rays = 10'000;
    const Scene scene = colourful_box();
    const FormFactors exact = exact_form_factors(scene), traced = traced_form_factors(scene, rays, 1);
    std::vector<double> p_values;
    for (std::size_t i = 0; i < exact.patches(); ++i)
        for (std::size_t j = 0; j < exact.patches(); ++j)
            if (exact(i, j) > 0)
                p_values.push_back(binomial_test(std::llround(traced(i, j) * rays), rays, exact(i, j)));
            else
                ASSERT_EQ(traced(i, j), 0);
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

TEST(DenseIrradiance, IsExactInAFurnace) {
    const Scene scene = closed_box({1, 2, 3}, 2, {{"wall", Rgb(0.5f, 0.75f, 0), Rgb(2)}});
    for (const RgbD& h : dense_irradiance(scene, exact_form_factors(scene))) {
        EXPECT_NEAR(h.x, 4, 1e-9);  // H = B = M / (1 - rho)
        EXPECT_NEAR(h.y, 8, 1e-9);
        EXPECT_NEAR(h.z, 2, 1e-9);
    }
}

}  // namespace
}  // namespace interflect
