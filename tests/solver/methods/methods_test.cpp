// Tests of the methods of variants_of_other_methods(): iwdrs, random walks, photon mesh, global lines and progressive
// refinement. The mean over many seeds must be the exact solution, escaped power is counted, and the error decreases
// with the rays and is estimated. A new stochastic row of the table is tested automatically.
//
// Each test that compares samples with a true value fails for correct code with probability `false_alarm`, once and for
// all, because the seeds are fixed.
//
// Seen to fail, for global lines: half the payload, lines that transport light in one direction only, directions
// uniform in angle instead of on the sphere, offsets that cluster near the centre, the same lines for all bounces,
// escaped power counted once, exchange in both directions through the back of a face. For progressive refinement: shot
// power stays unshot, power that was not selected is lost, the rest is not passed on, a step shoots more than it
// subtracts, iterations end with 30% unshot.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr std::uint64_t runs = 24;
constexpr std::int64_t rays_of_run = 100'000;

SolveOptions options_of(const Variant& variant, std::int64_t rays, std::uint64_t seed) {
    SolveOptions o = variant.options;
    o.importance.camera_rays = 4000;
    o.limits.rays = rays;
    o.seed = seed;
    return o;
}

std::vector<Solution> solutions_by(const Variant& variant, const Scene& scene) {
    const RayCaster ray_caster(scene);
    // Global lines ignore the distribution of light, so they need more rays for the same noise.
    const std::int64_t rays = variant.name.starts_with("global_lines") ? 8 * rays_of_run : rays_of_run;
    std::vector<Solution> all;
    for (std::uint64_t seed = 1; seed <= runs; ++seed)
        all.push_back(solve(scene, ray_caster, options_of(variant, rays, seed)));
    return all;
}

class EveryMethod : public testing::TestWithParam<Variant> {
  protected:
    SolveOptions options(std::int64_t rays, std::uint64_t seed) const { return options_of(GetParam(), rays, seed); }
    std::vector<Solution> solutions(const Scene& scene) const { return solutions_by(GetParam(), scene); }
};

/// Light is constant on patches, so the dense solution is exact.
class EveryFlatMethod : public EveryMethod {};

enum class Meshes { any, flat };

/// Returns each method without a view, and with importance if importance can steer it.
std::vector<Variant> with_and_without_importance(Meshes mesh) {
    std::vector<Variant> variants;
    for (Variant v : variants_of_other_methods()) {
        if (mesh == Meshes::flat && v.options.method.refines) continue;
        v.options.method.importance = ImportanceUse::off;
        variants.push_back(v);
        if (v.options.method.no_importance) continue;
        v.name += "_with_importance";
        v.options.method.importance = ImportanceUse::full;
        v.options.views = {{into_the_corner}};
        variants.push_back(v);
    }
    return variants;
}
INSTANTIATE_TEST_SUITE_P(All, EveryMethod, testing::ValuesIn(with_and_without_importance(Meshes::any)),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(All, EveryFlatMethod, testing::ValuesIn(with_and_without_importance(Meshes::flat)),
                         [](const auto& test) { return test.param.name; });

/// Returns the p-value of the hypothesis that the expected values of all patches and channels are `factor` times these.
double p_value(const std::vector<Solution>& solutions, const std::vector<RgbD>& expected, double factor) {
    std::vector<double> p_values;
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            std::vector<double> values;
            for (const Solution& s : solutions) values.push_back(s.irradiance[i][c]);
            p_values.push_back(t_test(values, factor * expected[i][c]));
        }
    return bonferroni(p_values);
}

/// The same for the area-weighted mean, which has less noise.
double p_value_of_mean(const Scene& scene, const std::vector<Solution>& solutions, const std::vector<RgbD>& expected,
                       double factor) {
    std::vector<double> values;
    double exact = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        exact += channel_sum(expected[i]) * patch_area(scene, scene.patches[i]);
    for (const Solution& s : solutions) {
        values.push_back(0);
        for (std::size_t i = 0; i < expected.size(); ++i)
            values.back() += channel_sum(RgbD(s.irradiance[i])) * patch_area(scene, scene.patches[i]);
    }
    return t_test(values, factor * exact);
}

// A closed box with exitance M and reflectance rho everywhere has H = M / (1 - rho).
TEST_P(EveryMethod, FillsAFurnaceEvenly) {
    constexpr double exitance = 2;  // [W/m^2]
    for (const double rho : {0.0, 0.5, 0.9}) {
        const Scene scene =
            closed_box({1, 2, 3}, 3, {{"wall", Rgb(static_cast<float>(rho)), Rgb(static_cast<float>(exitance))}});
        const std::vector<Solution> sample = solutions(scene);
        const std::vector<RgbD> expected(scene.patches.size(), RgbD(exitance / (1 - rho)));
        EXPECT_GT(p_value(sample, expected, 1), false_alarm) << "rho " << rho;
        EXPECT_LT(p_value(sample, expected, 1.03), false_alarm) << "would notice 3%, rho " << rho;
        EXPECT_LT(p_value_of_mean(scene, sample, expected, 1.015), false_alarm) << "would notice 1.5%, rho " << rho;
        for (const Solution& s : sample) EXPECT_EQ(s.iterations.back().escaped_rays + s.non_finite, 0);
    }
}

TEST_P(EveryFlatMethod, HasTheMeanOfTheDenseSolutionAndCountsEscapes) {
    const Scene scene = open_colourful_box();
    const FormFactors f = exact_form_factors(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, f);
    const std::vector<Solution> sample = solutions(scene);
    EXPECT_GT(p_value(sample, exact, 1), false_alarm);
    EXPECT_LT(p_value(sample, exact, 1.04), false_alarm) << "would notice 4%";
    EXPECT_GT(p_value_of_mean(scene, sample, exact, 1), false_alarm);
    EXPECT_LT(p_value_of_mean(scene, sample, exact, 1.02), false_alarm) << "would notice 2%";

    double escaping = 0;
    for (std::uint32_t i = 0; i < exact.size(); ++i) {
        const Material& material = scene.materials[scene.patches[i].material];
        const RgbD radiosity = RgbD(material.exitance) + RgbD(material.reflectance) * exact[i];
        escaping += channel_sum(radiosity) * patch_area(scene, scene.patches[i]) * (1 - f.row_sum(i));
    }
    std::vector<double> escaped;
    for (const Solution& s : sample) escaped.push_back(channel_sum(s.iterations.back().escaped_power));
    EXPECT_GT(t_test(escaped, escaping), false_alarm);
    EXPECT_LT(t_test(escaped, 1.05 * escaping), false_alarm) << "would notice 5%";
}

/// Returns the irradiance of patches by a long run of srr, or of hsrr if light varies within patches.
std::vector<RgbD> irradiance_by_a_long_run(const Scene& scene, bool refines) {
    SolveOptions options{.method = find_method(refines ? "hsrr" : "srr")};
    options.limits.rays = 8'000'000;
    const Solution expected = solve(scene, RayCaster(scene), options);
    return {expected.irradiance.begin(), expected.irradiance.begin() + scene.patches.size()};
}

/// Expects the mean of the runs of each variant to agree with a long run, which the variants have in common.
void expect_agreement(const Scene& scene, const std::vector<Variant>& variants) {
    const std::vector<RgbD> flat = irradiance_by_a_long_run(scene, false),
                            refined = irradiance_by_a_long_run(scene, true);
    for (const Variant& variant : variants) {
        SCOPED_TRACE(variant.name);
        const std::vector<Solution> sample = solutions_by(variant, scene);
        const std::vector<RgbD>& exact = variant.options.method.refines ? refined : flat;
        EXPECT_GT(p_value(sample, exact, 1), false_alarm);
        EXPECT_LT(p_value(sample, exact, 1.05), false_alarm) << "would notice 5%";
    }
}

// The back of a one-sided face transmits light, in one direction only. A screen that faces the lamp shades the wall
// behind it, but does not block the light from that wall.
TEST(EveryMethod, AgreesWithOthersWhereFacesAreSeenFromBehind) {
    Scene scene = colourful_box();
    const std::uint32_t white = add_material(scene, Rgb(0.7f), Rgb(0));
    add_rectangle(scene, {0.2f, 0.3f, 1.2f}, {0.6f, 0, 0}, {0, 1.3f, 0.2f}, white);
    expect_agreement(scene, with_and_without_importance(Meshes::any));
}

TEST(EveryMethod, ShootsOrRefusesLightSourcesThatAreNoSurfaces) {
    Scene scene = colourful_box();
    scene.luminaires = {{"lamp", 0, PointLight{{0.4f, 0.7f, 1.9f}, {20, 30, 20}}}};
    std::vector<Variant> shooting;
    for (const Variant& variant : with_and_without_importance(Meshes::any))
        if (variant.options.method.takes_luminaires)
            shooting.push_back(variant);
        else
            EXPECT_THROW(solve(scene, RayCaster(scene), options_of(variant, 1000, 1)), InputError) << variant.name;
    expect_agreement(scene, shooting);
}

// Without a view, the estimate is the error of all surfaces, which is known here. The root mean square of eight seeds
// is accurate to about 10%.
TEST_P(EveryFlatMethod, ErrorFallsWithTheRaysAndIsReported) {
    if (!GetParam().options.views.empty()) return;
    constexpr std::uint64_t seeds = 8;
    constexpr std::int64_t few = 100'000, many = 16 * few;
    const Scene scene = colourful_box();
    const RayCaster ray_caster(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, exact_form_factors(scene));
    const auto error = [&](std::int64_t rays, PointSet points) {
        double square = 0, estimated_square = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            SolveOptions o = options(rays, seed);
            o.experimental.points = points;
            const Solution s = solve(scene, ray_caster, o);
            square += std::pow(relative_error(scene, s.irradiance, exact), 2) / seeds;
            estimated_square += std::pow(s.iterations.back().error_estimate, 2) / seeds;
        }
        const double estimate_over_error = std::sqrt(estimated_square / square);
        EXPECT_GT(estimate_over_error, 0.75) << rays << " rays";
        EXPECT_LT(estimate_over_error, points == PointSet::random ? 1.3 : 1.6) << rays << " rays";
        return std::sqrt(square);
    };
    const double ratio = error(few, PointSet::random) / error(many, PointSet::random);
    EXPECT_GT(ratio, 3.3);
    EXPECT_LT(ratio, 5.5);
    EXPECT_GT(error(few, PointSet::sobol) / error(many, PointSet::sobol), 3.3);
}

/// Methods that improve a first estimate reported iteration 0 twice: after the initial mesh and after the estimate.
TEST(Reports, AreNumberedInSequence) {
    const Scene scene = furnished_room();
    for (const char* name : {"hsrr", "wdrs", "hwdrs"}) {
        SolveOptions options{.method = find_method(name)};
        options.limits.rays = 20'000;
        const Solution solution = solve(scene, RayCaster(scene), options);
        ASSERT_GT(solution.iterations.size(), 1u) << name;
        for (std::size_t i = 0; i < solution.iterations.size(); ++i)
            EXPECT_EQ(solution.iterations[i].iteration, static_cast<int>(i)) << name;
    }
}

}  // namespace
}  // namespace interflect
