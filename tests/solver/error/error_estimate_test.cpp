// Error estimate of a run, and the mesh made for it. Both must be the same with and without the lamp in the picture,
// because they exclude emission. The true picture is that of a long run, shaded flat, without the light that the lamp
// emits directly to the camera.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/render/render_elements.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr int width = 160, height = 90;  // of pictures [pixels]

/// Returns a room of 4 x 3 x 2.5 m with a table, and a lamp on its far wall near the ceiling.
Scene room() {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    const std::uint32_t wood = add_material(scene, Rgb(0.4f), Rgb(0)), lamp = add_material(scene, Rgb(0), Rgb(300));
    add_rectangle(scene, {1.5f, 1, 0.7f}, {1.2f, 0, 0}, {0, 0.9f, 0}, wood, 1, 1, true);
    add_rectangle(scene, {3.9f, 1.2f, 2.1f}, {0, 0, 0.08f}, {0, 0.6f, 0}, lamp);  // shines towards -x
    return scene;
}

/// Returns a view from the near wall towards the far one. The lamp is at the upper edge of the picture or just above
/// it.
WeightedView view(bool shows_lamp) {
    WeightedView v;
    v.view = {"room", {0.2, 1.5, 1.4}, {4, 1.5, shows_lamp ? 1.13 : 0.93}, {0, 0, 1}, 34};
    v.pixel_rows = height;
    return v;
}

SolveOptions options_for(const std::string& method, bool shows_lamp, std::int64_t rays, std::uint64_t seed) {
    SolveOptions options{.method = find_method(method)};
    options.views = {view(shows_lamp)};
    options.limits.rays = rays;
    options.seed = seed;
    return options;
}

Image picture(const Scene& scene, const RayCaster& ray_caster, const Solution& s, const View& view,
              const std::vector<Rgb>& irradiance) {
    const PictureOptions options{.width = width, .height = height, .shading = Shading::flat, .samples = 64};
    return render(scene, *s.forest, ray_caster, view, irradiance, options).image;
}

/// Expects the estimates of a method to be its errors in the picture of `view(shows_lamp)`, in comparison with a long
/// run.
void expect_right_estimate(const Scene& scene, const RayCaster& ray_caster, const Solution& reference,
                           const std::string& method, bool shows_lamp) {
    constexpr int runs = 4;
    const View seen = view(shows_lamp).view;
    const Image truth = picture(scene, ray_caster, reference, seen, reference.irradiance);
    const Image emission =
        picture(scene, ray_caster, reference, seen, std::vector<Rgb>(reference.irradiance.size(), Rgb(0)));
    double mean = 0, emitted = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        mean += static_cast<double>(luminance(truth.pixels[i]) - luminance(emission.pixels[i])) /
                static_cast<double>(truth.pixels.size());
        emitted += luminance(emission.pixels[i]);
    }
    EXPECT_EQ(emitted > 0, shows_lamp) << "the lamp is where the test says";
    for (const std::int64_t rays : {300'000, 1'200'000}) {
        double estimate = 0, error = 0;  // mean squares over the runs
        std::string each;                // the runs' own estimates
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
            const Solution s = solve(scene, ray_caster, options_for(method, shows_lamp, rays, seed));
            const IterationReport& last = s.iterations.back();
            EXPECT_NEAR(last.error_estimate, std::hypot(last.noise_estimate, last.discretisation_estimate), 1e-9);
            estimate += std::pow(last.error_estimate, 2) / runs;
            each += std::to_string(last.noise_estimate) + ' ' + std::to_string(last.discretisation_estimate) + "; ";
            const Image found = picture(scene, ray_caster, s, s.options.views[0].view, s.irradiance);
            for (std::size_t i = 0; i < truth.pixels.size(); ++i)
                error +=
                    std::pow(static_cast<double>(luminance(found.pixels[i]) - luminance(truth.pixels[i])) / mean, 2) /
                    static_cast<double>(runs * truth.pixels.size());
        }
        const double ratio = std::sqrt(estimate / error);
        EXPECT_GT(ratio, 0.8) << rays << " rays, error " << std::sqrt(error) << ", noise and mesh " << each;
        EXPECT_LT(ratio, 1.25) << rays << " rays, error " << std::sqrt(error) << ", noise and mesh " << each;
    }
}

/// Tests each method with the lamp in the picture and outside it. One long run has a mesh for both pictures.
TEST(ErrorEstimate, IsTheErrorOfReflectedLightInThePicture) {
    const Scene scene = room();
    const RayCaster ray_caster(scene);
    SolveOptions long_run = options_for("hsrr", true, 24'000'000, 99);
    long_run.views.push_back(view(false));
    const Solution reference = solve(scene, ray_caster, long_run);
    for (const bool shows_lamp : {true, false})
        for (const char* method : {"hsrr", "ihsrr"}) {
            SCOPED_TRACE(std::string(method) + (shows_lamp ? ", lamp in the picture" : ", lamp outside it"));
            expect_right_estimate(scene, ray_caster, reference, method, shows_lamp);
        }
}

/// Returns the ratio of estimated to true error of a view, both as root mean squares over runs. The true picture is
/// that of a long run.
double estimate_over_truth(const Scene& scene, const WeightedView& view, std::int64_t rays) {
    constexpr int runs = 4;
    const RayCaster ray_caster(scene);
    const auto solved = [&](std::int64_t count, std::uint64_t seed) {
        SolveOptions options = options_for("ihsrr", false, count, seed);
        options.views = {view};
        return solve(scene, ray_caster, options);
    };
    const Solution reference = solved(40 * rays, 99);
    const Image truth = picture(scene, ray_caster, reference, view.view, reference.irradiance);
    double mean = 0, estimate = 0, error = 0;
    for (const Rgb& pixel : truth.pixels)
        mean += static_cast<double>(luminance(pixel)) / static_cast<double>(truth.pixels.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution s = solved(rays, seed);
        estimate += std::pow(s.iterations.back().error_estimate, 2) / runs;
        const Image found = picture(scene, ray_caster, s, s.options.views[0].view, s.irradiance);
        for (std::size_t i = 0; i < truth.pixels.size(); ++i)
            error += std::pow(static_cast<double>(luminance(found.pixels[i]) - luminance(truth.pixels[i])) / mean, 2) /
                     static_cast<double>(runs * truth.pixels.size());
    }
    return std::sqrt(estimate / error);
}

/// A floor and a lamp from above; most pixels show no surface.
TEST(ErrorEstimateOfAnOpenView, CountsThePixelsThatShowNothing) {
    Scene scene;
    scene.materials = {{"floor", Rgb(0.5f), Rgb(0)}, {"lamp", Rgb(0), Rgb(300)}};
    add_rectangle(scene, {0, 0, 0}, {2, 0, 0}, {0, 1.3f, 0}, 0);
    add_rectangle(scene, {0.9f, 0.8f, 0}, {0, 0.4f, 0}, {0, 0, 0.5f}, 0, 1, 1, true);
    add_rectangle(scene, {0.4f, 0.3f, 1.1f}, {0, 0.1f, 0}, {0.1f, 0, 0}, 1);
    WeightedView above;
    above.view = {"above", {1, 0.7, 4}, {1, 0.71, 0}, {0, 1, 0}, 50};
    above.pixel_rows = height;
    const double ratio = estimate_over_truth(scene, above, 300'000);
    EXPECT_GT(ratio, 0.8);
    EXPECT_LT(ratio, 1.25);
}

TEST(MeshByVariance, IsTheSameWithTheLampInThePictureAndOutsideIt) {
    const Scene scene = room();
    const RayCaster ray_caster(scene);
    const auto lamp = static_cast<std::uint32_t>(scene.patches.size() - 1);
    const auto leaves = [&](bool shows_lamp) {
        double count = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const Solution s = solve(scene, ray_caster, options_for("ihsrr", shows_lamp, 600'000, seed));
            EXPECT_EQ(s.view_importance[lamp] > 0, shows_lamp);
            for (const ElementIndex leaf : s.forest->leaves()) count += s.forest->patch(leaf) != lamp;
        }
        return count;
    };
    const double with_lamp = leaves(true), without = leaves(false);
    EXPECT_GT(without, 4 * 500);
    // The camera is turned, so the two pictures show different surfaces. When the threshold included emission, the lamp
    // halved the mesh. experiments/run acceptance measures larger scenes, where the lamp changes less than 5%.
    EXPECT_NEAR(with_lamp / without, 1, 0.05);
}

TEST(ErrorEstimateOfABlackView, IsInfiniteAndNeverEndsARun) {
    Scene scene = closed_box({4, 3, 2.5f}, 1,
                             {{"black", Rgb(0), Rgb(0)},
                              {"grey", Rgb(0.5f), Rgb(0)},
                              {"grey", Rgb(0.5f), Rgb(0)},
                              {"grey", Rgb(0.5f), Rgb(0)},
                              {"grey", Rgb(0.5f), Rgb(0)},
                              {"lamp", Rgb(0.5f), Rgb(10)}});
    SolveOptions options{.method = find_method("ihsrr")};
    options.views = {{View{"black", {2, 1.5, 1.2}, {0, 1.5, 1.2}, {0, 0, 1}, 30}}};
    options.limits.rays = 100'000;
    options.limits.until = 0.99;
    const RayCaster ray_caster(scene);
    const Solution s = solve(scene, ray_caster, options);
    for (const IterationReport& report : s.iterations) {
        EXPECT_TRUE(std::isinf(report.error_estimate));
        EXPECT_TRUE(std::isinf(report.noise_estimate));
    }
    // All light may be absorbed before the rays are used up.
    EXPECT_GT(s.iterations.back().rays, options.limits.rays / 10 * 9) << "no error is small enough where none is known";
    scene.materials[0].reflectance = Rgb(0.5f);
    const Solution grey = solve(scene, RayCaster(scene), options);
    EXPECT_LT(grey.iterations.back().error_estimate, 0.99);
    EXPECT_LT(grey.iterations.back().rays, options.limits.rays);
}

/// A pane that transmits all light fills the picture. Seen to fail, by a factor of 1.7, if the mean of the picture is
/// divided by the importance of all surfaces, which the pane doubles.
TEST(ErrorEstimateThroughGlass, IsThatWithoutAClearPane) {
    Scene scene = room();
    const auto estimate = [&] {
        const RayCaster ray_caster(scene);
        return solve(scene, ray_caster, options_for("ihsrr", false, 1'200'000, 1)).iterations.back().error_estimate;
    };
    const double without = estimate();
    const std::uint32_t glass = add_material(scene, Rgb(0), Rgb(0));
    scene.materials[glass].transmittance = Rgb(1);
    add_rectangle(scene, {0.4f, 0, 0}, {0, 3, 0}, {0, 0, 2.5f}, glass, 1, 1, true);
    EXPECT_NEAR(estimate() / without, 1, 0.25);
}

}  // namespace
}  // namespace interflect
