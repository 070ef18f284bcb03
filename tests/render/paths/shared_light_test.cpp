// Pictures and measurements whose paths several ranks share: the bits of one process, in rank 0.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "interflect/measure.h"
#include "interflect/preview.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/render/shared_light.h"
#include "interflect/render/sharing/light_order.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/thread_ranks.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// With a lamp, a point light, a window to an overcast sky and a low sun, and a mirror.
Scene room() {
    Scene scene = closed_box({4, 3, 2.5f}, 2, {{"wall", Rgb(0.6f, 0.4f, 0.5f), Rgb(0)}});
    scene.patches.pop_back();
    scene.materials.push_back({"lamp", Rgb(0), Rgb(40)});
    scene.materials.push_back({"mirror", Rgb(0.2f), Rgb(0)});
    scene.materials.back().specular_reflectance = Rgb(0.5f);
    add_rectangle(scene, {1, 1, 0.7f}, {1.5f, 0, 0}, {0, 1, 0}, 2, 1, 1, true);
    add_rectangle(scene, {2, 1, 2.4f}, {0, 0.5f, 0}, {0.5f, 0, 0}, 1, 1, 1, false);
    scene.luminaires = {{"", 0, PointLight{{0.3f, 0.4f, 2.1f}, {20, 30, 20}}},
                        {"", 0, SkyDome{{4, -0.7f}, Rgb(30)}},
                        {"", 0, DirectionalLight{{-1, 0.3f, -0.4f}, Rgb(500)}}};
    scene.light_groups = {{"lamps", "lamp"}};
    return scene;
}

struct Lit {
    Scene scene = room();
    RayCaster ray_caster{scene};
    View view{"", {3.5, 0.5, 1.6}, {0.5, 2, 0.9}, {0, 0, 1}, 70};
    Solution solution;
    Lit() {
        SolveOptions options{.method = find_method("ihsrr")};
        options.limits.rays = 30'000;
        options.views = {{view}};
        solution = solve(scene, ray_caster, options);
    }
};

const Lit& lit() {
    static const Lit result;
    return result;
}

/// Calls work(monitor) in rank 0, with which the others help.
void with_helpers(int count, const std::function<void(const Monitor&)>& work, const std::atomic<bool>* stop = nullptr) {
    ThreadRanks(count).run([&](Ranks& ranks) {
        if (ranks.rank() != 0) return share_light(lit().scene, &lit().solution, lit().ray_caster, ranks);
        work({.on_progress = {}, .stop = stop, .ranks = &ranks});
        end_shared_light(&ranks);
    });
}

void expect_equal(const SampledLight& a, const SampledLight& b) {
    EXPECT_EQ(a.direct.pixels, b.direct.pixels);
    EXPECT_EQ(a.indirect.pixels, b.indirect.pixels);
    EXPECT_EQ(a.direct_variance, b.direct_variance);
    EXPECT_EQ(a.indirect_variance, b.indirect_variance);
}

void expect_equal(const Rendering& a, const Rendering& b) {
    EXPECT_EQ(a.image.pixels, b.image.pixels);
    EXPECT_EQ(a.standard_error.pixels, b.standard_error.pixels);
    EXPECT_EQ(a.layers.normal.pixels, b.layers.normal.pixels);
    EXPECT_EQ(a.layers.depth, b.layers.depth);
    expect_equal(a.layers.reflected, b.layers.reflected);
    for (std::size_t h = 0; h < 2; ++h) expect_equal(a.layers.halves[h], b.layers.halves[h]);
    EXPECT_EQ(a.batches, b.batches);
    EXPECT_EQ(a.relative_error, b.relative_error);
    EXPECT_EQ(a.rays, b.rays);
    EXPECT_EQ(a.shadow_rays, b.shadow_rays);
    EXPECT_EQ(a.escaped_rays, b.escaped_rays);
}

struct Picture {
    const char* name;
    Shading shading;
    int samples;
    double until = 0;
    friend void PrintTo(const Picture& p, std::ostream* out) { *out << p.name; }
};

class SharedPicture : public testing::TestWithParam<Picture> {};
INSTANTIATE_TEST_SUITE_P(
    Shadings, SharedPicture,
    testing::Values(Picture{"path", Shading::path, 16}, Picture{"path_to_a_target", Shading::path, 8, 0.3},
                    Picture{"path_in_several_chunks", Shading::path, 64}, Picture{"instant", Shading::instant, 8},
                    Picture{"gather", Shading::gather, 16}, Picture{"hybrid", Shading::hybrid, 16}),
    [](const auto& picture) { return std::string(picture.param.name); });

Rendering draw(const PictureOptions& options, const Monitor& monitor) {
    return render(lit().scene, lit().solution, lit().ray_caster, lit().view, options, monitor);
}

TEST_P(SharedPicture, HasTheBitsOfOneProcess) {
    const PictureOptions options{.width = 80,
                                 .height = 64,  // three tiles of a path a pixel
                                 .shading = GetParam().shading,
                                 .samples = GetParam().samples,
                                 .max_samples = 128,
                                 .until = GetParam().until,
                                 .light_walks = 1000};
    const Rendering alone = draw(options, {});
    with_helpers(3, [&](const Monitor& monitor) { expect_equal(draw(options, monitor), alone); });
}

/// Direct light of near pixels shares coefficients, also where more paths are traced than one process traces at once.
TEST(SharedPicture, OfManyHybridPathsHasTheBitsOfOneProcess) {
    RELEASE_ONLY();  // see SharedPicture.HasTheBitsOfOneProcess
    const PictureOptions options{.width = 320, .height = 280, .shading = Shading::hybrid, .samples = 6};
    const Rendering alone = draw(options, {});
    with_helpers(3, [&](const Monitor& monitor) { expect_equal(draw(options, monitor), alone); });
}

/// Seen to fail if other ranks add the light of suns, which a preview adds by itself.
TEST(SharedPreview, HasTheBitsOfOneProcess) {
    const auto rough = [](const Monitor& monitor) {
        return preview(lit().scene, lit().solution, lit().ray_caster, lit().view, {.width = 320, .height = 256},
                       {.denoiser = Denoiser::own}, monitor);
    };
    const Rendering alone = rough({});
    with_helpers(3, [&](const Monitor& monitor) { EXPECT_EQ(rough(monitor).image.pixels, alone.image.pixels); });
}

TEST(SharedMeasurement, HasTheBitsOfOneProcess) {
    std::vector<MeasuringPoint> points;
    for (int i = 0; i < 200; ++i) points.push_back({{0.1 + 0.018 * i, 1.3, 0.9}, {0, 0, 1}});
    const auto measured = [&](const Monitor& monitor) {
        std::vector<Rgb> values;
        for (const Shading shading : {Shading::gather, Shading::path})
            for (const MeasuredIrradiance& e :
                 measure_irradiance(lit().scene, &lit().solution, lit().ray_caster, points,
                                    {.shading = shading, .samples = 64}, monitor)) {
                values.push_back(e.direct);
                values.push_back(e.indirect);
                values.push_back(e.standard_error);
            }
        return values;
    };
    const std::vector<Rgb> alone = measured({});
    with_helpers(3, [&](const Monitor& monitor) { EXPECT_EQ(measured(monitor), alone); });
}

TEST(SharedProbes, HaveTheBitsOfOneProcess) {
    const auto probes = [&](const Monitor& monitor) {
        return irradiance_probes(lit().scene, lit().solution, lit().ray_caster, {.spacing = 0.8f, .rays = 128}, monitor)
            .probes;
    };
    const std::vector<IrradianceProbe> alone = probes({});
    with_helpers(3, [&](const Monitor& monitor) {
        const std::vector<IrradianceProbe> shared = probes(monitor);
        ASSERT_EQ(shared.size(), alone.size());
        for (std::size_t i = 0; i < alone.size(); ++i) {
            EXPECT_EQ(shared[i].coefficients, alone[i].coefficients);
            EXPECT_EQ(shared[i].is_inside, alone[i].is_inside);
        }
    });
}

TEST(SharedPicture, OfALightGroupHasTheBitsOfOneProcess) {
    const Lit& all = lit();
    const LightOfGroup lamps = light_of_group(all.scene, all.solution, 0);
    EXPECT_NE(lamps.solution.irradiance, all.solution.irradiance);
    const RayCaster ray_caster(lamps.scene);
    const PictureOptions options{.width = 48, .height = 32, .shading = Shading::gather, .samples = 64};
    const auto drawn = [&](const Monitor& monitor) {
        return render(lamps.scene, lamps.solution, ray_caster, all.view, options, monitor);
    };
    const Rendering alone = drawn({});
    with_helpers(2, [&](const Monitor& monitor) {
        give_order(monitor.ranks, {.kind = LightOrder::Kind::group, .group = 0});
        expect_equal(drawn(monitor), alone);
        end_shared_light(monitor.ranks);
    });
}

/// The other ranks wait for the next order afterwards.
TEST(SharedPicture, OfAStoppedFirstRankEnds) {
    const std::atomic<bool> stop{true};
    const auto draw_and_measure = [&](const Monitor& monitor) {
        for (const Shading shading : {Shading::path, Shading::instant, Shading::gather, Shading::hybrid}) {
            const Rendering stopped = draw({.width = 48, .height = 32, .shading = shading, .samples = 64}, monitor);
            EXPECT_TRUE(stopped.interrupted);
            EXPECT_EQ(stopped.paths, 0);
        }
        EXPECT_THROW(irradiance_probes(lit().scene, lit().solution, lit().ray_caster, {}, monitor), Stopped);
    };
    with_helpers(3, draw_and_measure, &stop);
}

}  // namespace
}  // namespace interflect
