#include "interflect/rates.h"

#include <gtest/gtest.h>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using testing_support::closed_box;

SolveOptions few_rays() {
    SolveOptions options;
    options.limits.rays = 20'000;
    return options;
}

TEST(SolverRates, AreMeasuredInEveryRound) {
    const Scene scene = closed_box({2, 2, 2}, 2, {Material{"", Rgb(0.5f), Rgb(1)}});
    const SolverMeasurement measured = measure_solver(scene, RayCaster(scene), few_rays(), 2);
    EXPECT_GE(measured.elements, scene.patches.size());
    ASSERT_EQ(measured.rounds.size(), 2);
    for (const SolverRates& rates : measured.rounds) {
        EXPECT_GT(rates.solver, 0);
        EXPECT_GT(rates.embree.ceiling(), 0);
        for (const double share : {rates.making_rays, rates.tracing, rates.receiving, rates.refinement}) {
            EXPECT_GE(share, 0);
        }
        EXPECT_GE(rates.sweeps(), 0);
    }
}

TEST(SolverRates, NeedLight) {
    const Scene dark = closed_box({2, 2, 2}, 2, {Material{"", Rgb(0.5f)}});
    EXPECT_THROW(measure_solver(dark, RayCaster(dark), few_rays(), 1), InputError);
}

}  // namespace
}  // namespace interflect
