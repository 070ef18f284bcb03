#include "interflect/raycast/embree/ray_recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

const Scene recorded_square = [] {
    Scene scene;
    testing_support::add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                   testing_support::add_material(scene, Rgb(0.5f), Rgb(0)));
    return scene;
}();

constexpr std::size_t rays_of_call = 10;

/// Traces a call of ten rays, which all start at the height `call` and have the places 0 to 9.
void trace_call(const RayCaster& ray_caster, std::size_t call) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < rays_of_call; ++i)
        rays.push_back({{static_cast<float>(i), 0, static_cast<float>(call)}, {0, 0, -1}});
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
}

TEST(RayRecorder, KeepsAllOfFewRays) {
    const RayCaster ray_caster(recorded_square);
    trace_call(ray_caster, 99);
    const auto recorder = std::make_unique<RayRecorder>(ray_caster, 100);
    for (std::size_t call = 0; call < 10; ++call) trace_call(ray_caster, call);
    EXPECT_EQ(recorder->traced(), 100);
    const std::vector<Ray> kept = recorder->kept();
    ASSERT_EQ(kept.size(), 100u);
    for (std::size_t i = 0; i < kept.size(); ++i)
        EXPECT_EQ(kept[i].origin, V3f(static_cast<float>(i % rays_of_call), 0, static_cast<float>(i / rays_of_call)));
}

TEST(RayRecorder, SamplesWholeCallsOfMany) {
    constexpr std::size_t calls = 4000, max_rays = 4000;
    const RayCaster ray_caster(recorded_square);
    const RayRecorder recorder(ray_caster, max_rays);
    parallel_for_ranges(calls, 1, [&](std::size_t call, std::size_t) { trace_call(ray_caster, call); });
    EXPECT_EQ(recorder.traced(), static_cast<std::int64_t>(calls * rays_of_call));
    const std::vector<Ray> kept = recorder.kept();
    EXPECT_LE(kept.size(), max_rays);
    // 400 calls were halved last, when 401 were kept: fewer than 125 remain with a probability of 1e-14.
    EXPECT_GE(kept.size(), 125 * rays_of_call);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        EXPECT_EQ(kept[i].origin.x, static_cast<float>(i % rays_of_call));
        EXPECT_EQ(kept[i].origin.z, kept[i / rays_of_call * rays_of_call].origin.z);
    }
    // The mean of n independent uniform calls of N has the standard deviation N / sqrt(12 n); six of them.
    double mean = 0;
    for (const Ray& ray : kept) mean += static_cast<double>(ray.origin.z) / static_cast<double>(kept.size());
    const double deviation = calls / std::sqrt(12.0 * static_cast<double>(kept.size() / rays_of_call));
    EXPECT_NEAR(mean, calls / 2.0, 6 * deviation);
}

TEST(RayRecorder, EndsWithItsLifetime) {
    const RayCaster ray_caster(recorded_square);
    { const RayRecorder recorder(ray_caster, 1); }
    trace_call(ray_caster, 0);
    const RayRecorder another(ray_caster, 1);
    trace_call(ray_caster, 1);
    EXPECT_EQ(another.traced(), 10);
    EXPECT_EQ(another.kept().size(), 10u) << "a single call is kept whole";
}

}  // namespace
}  // namespace interflect
