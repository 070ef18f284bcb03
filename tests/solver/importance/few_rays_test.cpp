// Runs of few rays with a view. Their importance is inaccurate, and must cost no accuracy: compares the error of
// visible surfaces with and without importance in one room, where importance has no use. A long run without importance
// is the reference.
//
// Seen to fail if the first pass replaces the importance that was transported before it.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr int few_ray_runs = 16;

/// A room of 1,500 patches with a lamp and three boxes; most are visible.
Scene room_of_boxes() {
    Scene scene = closed_box({3, 2.4f, 2}, 16, {{"wall", Rgb(0.6f), Rgb(0)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0.3f), Rgb(900)), box = add_material(scene, Rgb(0.4f), Rgb(0));
    add_rectangle(scene, {1.4f, 1, 1.95f}, {0, 0.4f, 0}, {0.4f, 0, 0}, lamp);
    for (const float x : {0.4f, 1.2f, 2.1f}) add_box(scene, {x, 0.6f, 0}, {x + 0.5f, 1.1f, 0.3f + 0.4f * x}, box);
    return scene;
}

SolveOptions options_for(const char* method, std::int64_t rays, std::uint64_t seed) {
    SolveOptions options{
        .method = find_method(method), .views = {{{"", {0.1, 0.1, 1.6}, {3, 2.4, 0.5}}}}, .seed = seed};
    options.views[0].view.fov = 80;
    options.limits.rays = rays;
    options.refinement.min_area = 1;  // patches stay whole
    return options;
}

/// Returns the mean square error of the irradiance that the view shows, relative to the square of its mean.
std::vector<double> squared_errors(const Scene& scene, const char* method, std::int64_t rays) {
    const RayCaster ray_caster(scene);
    const Solution exact = solve(scene, ray_caster, options_for("srr", 4'000'000, 99));  // 40 or more times the rays
    std::vector<double> errors;
    for (std::uint64_t seed = 1; seed <= few_ray_runs; ++seed) {
        const Solution solution = solve(scene, ray_caster, options_for(method, rays, seed));
        double sum = 0, mean = 0;
        for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
            const double w = static_cast<double>(exact.view_importance[p]) * exact.forest->area(p);
            sum += w * std::pow(solution.irradiance[p].x - exact.irradiance[p].x, 2);
            mean += w * exact.irradiance[p].x;
        }
        errors.push_back(sum / (mean * mean));
    }
    return errors;
}

struct Methods {
    const char *with_importance, *without;
    std::int64_t rays;
};

void PrintTo(const Methods& m, std::ostream* out) { *out << m.with_importance << ", " << m.rays << " rays"; }

class FewRays : public testing::TestWithParam<Methods> {};

// Correct code fails with a probability below 1e-3 if the squared errors differ by the rays for importance alone: then
// the difference of the means of 16 errors exceeds 4 of its standard errors.
TEST_P(FewRays, CostNoAccuracyWithImportance) {
    const Scene scene = room_of_boxes();
    const std::vector<double> with_importance = squared_errors(scene, GetParam().with_importance, GetParam().rays),
                              without = squared_errors(scene, GetParam().without, GetParam().rays);
    const auto mean_of = [](const std::vector<double>& values) {
        double sum = 0;
        for (const double v : values) sum += v;
        return sum / static_cast<double>(values.size());
    };
    const auto variance_of_mean = [&](const std::vector<double>& values) {
        double sum = 0;
        for (const double v : values) sum += std::pow(v - mean_of(values), 2);
        return sum / static_cast<double>(values.size() * (values.size() - 1));
    };
    constexpr double of_fewer_rays = 1 / (1 - 0.1);  // --alpha: a tenth of the rays is sampled by importance
    EXPECT_LT(mean_of(with_importance),
              of_fewer_rays * mean_of(without) +
                  4 * std::sqrt(variance_of_mean(with_importance) + variance_of_mean(without)));
}

INSTANTIATE_TEST_SUITE_P(All, FewRays,
                         testing::Values(Methods{"isrr", "srr", 100'000}, Methods{"ihsrr", "hsrr", 100'000}),
                         [](const auto& test) {
                             return std::string(test.param.with_importance) + "_" + std::to_string(test.param.rays);
                         });

}  // namespace
}  // namespace interflect
