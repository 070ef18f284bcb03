// Selection of bright elements for final gathering, by their visibility from the points of a picture.
//
// Seen to fail: hidden patches keep their power; patches without test rays keep their power; one lost ray removes a
// patch; the limit is twice the mean over all surfaces.
#include "interflect/render/prepared/seen_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/ray_caster.h"
#include "interflect/render/gauges/gauge_light.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Calls visit(light) with the known light for these points.
void with_known_light(const Scene& scene, const std::vector<Rgb>& irradiance, const std::vector<SurfacePoint>& points,
                      const auto& visit) {
    const RayCaster ray_caster(scene);
    const ElementForest forest(scene, scene.patches.size());
    const KnownIrradiance known{forest, irradiance, irradiance};
    const TracedScene traced(scene, ray_caster);
    visit(known_light(traced, known, points, 1));
}

TEST(KnownLight, ReflectsTheUnreducedIrradiance) {
    const Scene scene = closed_box({4, 4, 3}, 1, {Material{"", Rgb(0.5f)}});
    const RayCaster ray_caster(scene);
    const TracedScene traced(scene, ray_caster);
    const ElementForest forest(scene, scene.patches.size());
    const std::vector<Rgb> reduced(forest.size(), Rgb(2)), unreduced(forest.size(), Rgb(6));
    const KnownLight light(scene, traced.geometry, {forest, reduced, unreduced});
    const KnownLight::Place place = light.place(PatchIndex(0), scene.vertices[scene.patches[0].vertices[0]]);
    EXPECT_EQ(light.irradiance(place), Rgb(2));
    EXPECT_FLOAT_EQ(light.reflected_radiance(place).x, 0.5f * 6 / std::numbers::pi_v<float>);
}

/// A room with a small sunlit spot on its floor and two walls of medium brightness. Outside, their backs are in the
/// sun.
struct House {
    Scene scene = closed_box({4, 4, 3}, 2, {Material{"", Rgb(0.5f)}});
    std::uint32_t spot = add_rectangle(scene, {1, 1, 0.01f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 0, 2, 2);
    std::vector<Rgb> irradiance;
    std::vector<SurfacePoint> points;  // in the middle of the room, below the ceiling

    explicit House(bool has_outside) {
        irradiance.assign(scene.patches.size(), Rgb(1));
        for (std::size_t i = 0; i < 4; ++i) {
            irradiance[i] = irradiance[8 + i] = Rgb(9);
            irradiance[spot + i] = Rgb(100);
        }
        if (has_outside) {
            add_rectangle(scene, {-0.1f, 0, 0}, {0, 0, 3}, {0, 4, 0}, 0, 2, 2);
            add_rectangle(scene, {0, -0.1f, 0}, {4, 0, 0}, {0, 0, 3}, 0, 2, 2);
            irradiance.resize(scene.patches.size(), Rgb(1e6f));
        }
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            const auto words = random_words(7, i);
            const V3f x(1 + 2 * unit_float(words[0]), 1 + 2 * unit_float(words[1]), 2 + unit_float(words[2]));
            points.push_back({x, {0, 0, -1}, no_patch, 0.01f});
        }
    }

    /// Share of samples that find the spot.
    double share_of_spot() const {
        int found = 0;
        with_known_light(scene, irradiance, points, [&](const KnownLight& light) {
            for (std::uint64_t i = 0; i < points.size(); ++i) {
                const auto words = random_words(8, i);
                const KnownLight::Place place = light
                                                    .sample(points[i].position, points[i].normal, unit_float(words[0]),
                                                            unit_float(words[1]), unit_float(words[2]))
                                                    .place;
                found += place.patch >= spot && place.patch < spot + 4;
            }
        });
        return found / static_cast<double>(points.size());
    }
};

TEST(SeenLight, IsThatOfARoomAlsoIfTheSunShinesOutside) {
    const double without_outside = House(false).share_of_spot();
    EXPECT_GT(without_outside, 0.1);
    EXPECT_GT(House(true).share_of_spot(), 0.8 * without_outside);
}

/// Thousands of bright patches get about one test ray each, and many get 0, but all must stay likely.
TEST(SeenLight, SamplesManySmallPatchesAlike) {
    RELEASE_ONLY();
    Scene scene = closed_box({4, 4, 3}, 4, {Material{"", Rgb(0.5f)}});
    const auto dim = static_cast<std::uint32_t>(scene.patches.size());
    add_rectangle(scene, {1, 1, 2.9f}, {0, 2, 0}, {2, 0, 0}, 0, 400, 400);
    std::vector<Rgb> irradiance(scene.patches.size(), Rgb(100));
    std::fill_n(irradiance.begin(), dim, Rgb(1));
    const std::vector<SurfacePoint> points(100'000, {{2, 2, 0.01f}, {0, 0, 1}, no_patch, 0.01f});
    with_known_light(scene, irradiance, points, [&](const KnownLight& light) {
        const std::span<const float> powers = light.sampling_powers().subspan(dim);
        const auto [least, most] = std::minmax_element(powers.begin(), powers.end());
        EXPECT_GT(*least, *most / 20);
    });
}

}  // namespace
}  // namespace interflect
