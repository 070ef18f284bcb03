// Light sources that are not surfaces, on the hierarchy, in pictures. The reference is path tracing, which shares only
// the ray casting with the solver.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interflect/render/render_elements.h"
#include "interflect/solve.h"
#include "tests/support/rooms/room_with_window.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr int blocks = 6;  // along each side of a picture

/// Returns the sum of luminance in each block of a picture of 72 x 48 pixels.
std::vector<double> sums_of_blocks(const Image& image) {
    std::vector<double> sums(blocks * blocks, 0);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 72; ++x)
            sums[static_cast<std::size_t>(y * blocks / 48 * blocks + x * blocks / 72)] +=
                luminance(image.pixels[static_cast<std::size_t>(y * 72 + x)]);
    return sums;
}

/// A room with a window, a lamp, a spot light and the sun. With the hierarchy and importance, the mean and blocks of
/// the picture agree with path tracing. Shading is flat, so interpolation is not tested.
TEST(LightSourcesOnTheHierarchy, AgreeWithPathTracing) {
    Scene scene = room_with_window({300, 350, 420});
    scene.materials[0].reflectance = {0.6f, 0.5f, 0.4f};
    scene.luminaires.push_back({"lamp", 0, PointLight{{3.1f, 2.2f, 2.4f}, {60, 60, 40}}});
    scene.luminaires.push_back({"spot", 0, SpotLight{{4, 1, 2.9f}, {-1, 0.5f, -2}, {200, 100, 100}, 15, 35}});
    auto web = std::make_shared<PhotometricWeb>();  // a box below the ceiling that also emits upwards
    web->polar = {0, 60, 90, 180}, web->azimuth = {0, 90, 180, 270, 360};
    web->intensities = {90, 80, 20, 40, 90, 40, 10, 40, 90, 80, 20, 40, 90, 40, 10, 40, 90, 80, 20, 40};
    web->opening.size = {1.2f, 0.2f, 0.1f};
    scene.luminaires.push_back({"box", 0, MeasuredLight{web, {2, 2.5f, 2.3f}, {0, 0, -1}, {1, 1, 0}, false, Rgb(1)}});
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{2, 0.3f, -1}, {2000, 1900, 1500}}});
    const RayCaster ray_caster(scene);
    const View view{"room", {4.7, 3.7, 1.6}, {0.5, 1.2, 0.9}, {0, 0, 1}, 70};
    const PictureOptions paths{.width = 72, .height = 48, .shading = Shading::path, .samples = 512};
    const std::vector<double> reference = sums_of_blocks(render(scene, ray_caster, view, paths).image);
    for (const auto& [method, criterion] : {std::pair{"ihsrr", RefinementCriterion::variance},
                                            {"ihsrr", RefinementCriterion::power},
                                            {"hwdrs", RefinementCriterion::power}}) {
        SCOPED_TRACE(std::string(method) + (criterion == RefinementCriterion::variance ? " by variance" : " by power"));
        SolveOptions options{.method = find_method(method)};
        options.refinement.criterion = criterion;
        options.views = {{view, 1, 1.5f, 48}};
        options.limits.rays = 4'000'000;
        const Solution solution = solve(scene, ray_caster, options);
        const PictureOptions picture{.width = 72, .height = 48, .shading = Shading::flat};
        const std::vector<double> found =
            sums_of_blocks(render(scene, *solution.forest, ray_caster, view, solution.irradiance, picture).image);
        double sum = 0, expected = 0, squares = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            sum += found[i];
            expected += reference[i];
            squares += std::pow(found[i] / reference[i] - 1, 2) / static_cast<double>(found.size());
        }
        EXPECT_NEAR(sum / expected, 1, 0.01);
        EXPECT_LT(std::sqrt(squares), 0.04);
    }
}

}  // namespace
}  // namespace interflect
