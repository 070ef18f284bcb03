// All ways of drawing use the same normals.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const View into_room{"room", {3.6, 2.7, 1.6}, {0.4, 0.3, 0.3}, {0, 0, 1}, 60};
const PictureOptions few_samples{.width = 24, .height = 16, .samples = 8};

/// A room with a lamp and a block.
Scene room_with_block() {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {Material{"", Rgb(0.6f), Rgb(0)}});
    add_rectangle(scene, {1, 1, 2.4f}, {0, 0.6f, 0}, {0.6f, 0, 0}, add_material(scene, Rgb(0), Rgb(9000)));
    add_box(scene, {0.8f, 0.8f, 0.1f}, {1.8f, 1.6f, 0.9f}, add_material(scene, Rgb(0.3f), Rgb(0)));
    return scene;
}

struct Picture {
    std::string shading;
    std::vector<Rgb> pixels;
};

std::vector<Picture> all_pictures(const Scene& scene, const View& view, const PictureOptions& options) {
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 50'000}});
    std::vector<Picture> pictures;
    for (const Shading shading : {Shading::path, Shading::instant, Shading::gather, Shading::hybrid, Shading::smooth})
        pictures.push_back(
            {label(shading), render(scene, solution, ray_caster, view, by(shading, options)).image.pixels});
    return pictures;
}

/// The block's corners have the averages of its faces' normals, as some programs export them. Seen to fail with the
/// normals of the file.
TEST(Normals, OfABlockWithAveragedCornersChangeNoPicture) {
    const Scene plain = room_with_block();
    Scene averaged = plain;
    averaged.normals.assign(plain.vertices.size(), V3f(0));
    const V3f centre(1.3f, 1.2f, 0.5f);
    for (std::size_t v = 0; v < plain.vertices.size(); ++v)
        if ((plain.vertices[v] - centre).length() < 0.8f)
            averaged.normals[v] = (plain.vertices[v] - centre).normalized();
    const std::vector<Picture> expected = all_pictures(plain, into_room, few_samples),
                               found = all_pictures(averaged, into_room, few_samples);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].pixels, expected[i].pixels) << found[i].shading;
}

/// Half a cylinder of two facets of 45 degrees about the y axis, in parallel light that no surface reflects: each pixel
/// is E cos(n, l) for the normal of the cylinder. Two rows of pixels see it from above; rho = 0.01 adds at most 1%.
/// Seen to fail by 10% for path tracing with the normals of the facets.
TEST(Normals, OfACoarseCylinderAreTheSameInPathTracingGatheringAndHybridShading) {
    RELEASE_ONLY();
    Scene scene;
    const std::uint32_t grey = add_material(scene, Rgb(0.01f), Rgb(0));
    constexpr float step = std::numbers::pi_v<float> / 4;
    for (int i = 0; i <= 2; ++i)
        for (const float y : {0.0f, 1.0f}) {
            const float angle = static_cast<float>(i - 1) * step;
            const V3f out(std::sin(angle), 0, std::cos(angle));
            scene.vertices.push_back(out + V3f(0, y, 0));
            scene.normals.push_back(out);
        }
    scene.objects = {""};
    scene.patches = {{.vertices = {0, 2, 3, 1}, .material = grey}, {.vertices = {2, 4, 5, 3}, .material = grey}};
    const V3f towards = V3f(0.3f, 0, 1).normalized();
    scene.luminaires.push_back({"sun", 0, DirectionalLight{.direction = -towards, .irradiance = Rgb(1000)}});
    View above{"above", {0, 0.5, 4}, {0, 0.5, 0}, {0, 1, 0}, 45};
    above.extent = 0.1f;
    PictureOptions options = few_samples;
    options.height = 2;
    options.width = 2;
    options.quantity = PictureQuantity::irradiance;
    for (const float x : {-0.6f, -0.2f, 0.2f, 0.6f}) {
        above.eye.x = above.look_at.x = x;
        // The normal is interpolated along the facet, whose x is linear in its parameter.
        const float end = std::sin(step), t = std::abs(x) / end;
        const V3f n = (V3f(0, 0, 1) * (1 - t) + V3f(std::copysign(end, x), 0, std::cos(step)) * t).normalized();
        for (const Picture& picture : all_pictures(scene, above, options)) {
            if (picture.shading == "smooth") continue;  // approximates by elements
            for (const Rgb& pixel : picture.pixels)
                EXPECT_NEAR(pixel.x, 1000 * n.dot(towards), 40) << picture.shading << " " << x;
        }
    }
}

}  // namespace
}  // namespace interflect
