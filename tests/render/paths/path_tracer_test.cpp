// The path tracer against exact answers: closed boxes of one exitance and reflectance, and form factors between
// parallel rectangles. Seen to fail with each of these mutations:
// - rho wrong or missing;
// - pi missing in the emission of a hit lamp, of a chosen lamp, in the density of directions, or in the weight of
//   chance hits;
// - the probability of a patch, the area of a lamp or its cosine missing;
// - in the light tree: estimate without distances, probabilities exchanged, number not rescaled, boxes culled by their
//   centres;
// - chance hits with full weight; survivors of roulette not scaled up; at most 30 bounces;
// - directions uniform over the hemisphere; only points near the middle of a lamp; shadow rays that ignore blockers;
// - the same random numbers for all batches, or for all vertices; no ray offset; standard errors 15% too large.
#include "interflect/render.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <numbers>
#include <vector>

#include "interflect/core.h"
#include "tests/support/form_factors.h"
#include "tests/support/parameter_names.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;
using testing_support::bonferroni;
using testing_support::by;
using testing_support::closed_box;
using testing_support::false_alarm;
using testing_support::Rectangle;
using testing_support::t_test;
using testing_support::V3d;

using std::numbers::pi;

struct Pictures {
    std::vector<Rendering> runs;

    Pictures(const Scene& scene, const View& view, PictureOptions options, int count) {
        const RayCaster ray_caster(scene);
        for (int i = 0; i < count; ++i) {
            options.seed = static_cast<std::uint64_t>(i) + 1;
            runs.push_back(render(scene, ray_caster, view, by(Shading::path, options)));
            EXPECT_EQ(runs.back().non_finite_pixels, 0);
        }
    }

    std::vector<double> values(std::size_t pixel, int channel) const {
        std::vector<double> result;
        for (const Rendering& run : runs) result.push_back(run.image.pixels[pixel][channel]);
        return result;
    }
    std::vector<double> means() const {
        std::vector<double> result;
        for (const Rendering& run : runs) {
            double sum = 0;
            for (const Rgb& pixel : run.image.pixels) sum += channel_sum(pixel) / 3;
            result.push_back(sum / static_cast<double>(run.image.pixels.size()));
        }
        return result;
    }

    /// Computes the p-value for all pixels and channels, and their mean, having the expected values.
    double p_value(const std::vector<RgbD>& expected, double factor = 1) const {
        std::vector<double> p;
        double mean = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                p.push_back(t_test(values(i, c), factor * expected[i][c]));
                mean += factor * expected[i][c] / static_cast<double>(3 * expected.size());
            }
        return std::min(1.0, 2 * std::min(bonferroni(p), t_test(means(), mean)));
    }
};

// A closed box of any shape with exitance M and reflectance rho everywhere has radiosity B = M + rho B = M / (1 - rho).
// It is 1 x 2 x 3 m, so that all pairs of walls differ.

class PathFurnace : public testing::TestWithParam<float> {
  protected:
    Rgb rho() const { return Rgb(1, 0.9f, 0.5f) * GetParam(); }
    Pictures pictures() const {
        const Scene box = closed_box(V3f(1, 2, 3), 2, {{"wall", rho(), exitance}});
        const View view{"corner", V3f(0.1f, 0.2f, 0.3f), V3f(0.9f, 1.8f, 2.8f), V3f(0, 0, 1), 80};
        const PictureOptions options{.width = 6, .height = 4, .samples = 64};
        return Pictures(box, view, options, 24);
    }
    std::vector<RgbD> expected() const {
        const RgbD unit(1, 1, 1);
        return std::vector<RgbD>(6 * 4, RgbD(exitance) / (unit - RgbD(rho())) / pi);
    }
    static inline const Rgb exitance{2, 1, 0.5f};
};
INSTANTIATE_TEST_SUITE_P(Rho, PathFurnace, testing::Values(0.1f, 0.5f, 0.9f), testing_support::printed_name);

TEST_P(PathFurnace, IsUnbiasedAndWouldNoticeTwoPercent) {
    RELEASE_ONLY();
    const Pictures seen = pictures();
    EXPECT_GT(seen.p_value(expected()), false_alarm);
    EXPECT_LT(seen.p_value(expected(), 1.02), false_alarm);
    for (const Rendering& run : seen.runs) EXPECT_EQ(run.escaped_rays, 0);
}

/// The two-sided box, rotated and 50 m from the origin. A ray that starts on or below its surface would leave it.
TEST(PathTracer, NoRayLeavesAClosedBox) {
    const Scene box = closed_box(V3f(1, 2, 3), 2, {{"wall", Rgb(0.7f, 0.7f, 0.7f), Rgb(1, 1, 1)}});
    const V3f x = V3f(2, 1, 2) / 3.0f, y = V3f(-2, 2, 1) / 3.0f, z = V3f(-1, -2, 2) / 3.0f;  // orthonormal
    const auto move = [&](const V3f& v) { return V3f(50, -30, 20) + x * v.x + y * v.y + z * v.z; };
    Scene moved = box;
    moved.patches.clear();
    for (V3f& v : moved.vertices) v = move(v);
    for (Patch front : box.patches) {
        const PatchIndex index(moved.patches.size());
        Patch back = front;
        std::swap(back.vertices[1], back.vertices[3]);
        front.other_side = index + 1;
        back.other_side = index;
        moved.patches.push_back(front);
        moved.patches.push_back(back);
    }
    const View view{"corner", move(V3f(0.1f, 0.2f, 0.3f)), move(V3f(0.9f, 1.8f, 2.8f)), z, 80};
    const Pictures seen(moved, view, {.width = 6, .height = 4, .samples = 64}, 24);
    for (const Rendering& run : seen.runs) EXPECT_EQ(run.escaped_rays, 0);
    const std::vector<RgbD> expected(6 * 4, RgbD(1, 1, 1) / (1 - static_cast<double>(0.7f)) / pi);
    EXPECT_GT(seen.p_value(expected), false_alarm);
}

/// Paths of a hundred bounces: a limit on bounces, or roulette without scaling of the survivors, fails here.
TEST(PathTracer, IsUnbiasedInAnAlmostWhiteBox) {
    RELEASE_ONLY();  // see SharedPicture.HasTheBitsOfOneProcess
    const Scene box = closed_box(V3f(1, 2, 3), 1, {{"wall", Rgb(0.99f, 0.99f, 0.99f), Rgb(1, 1, 1)}});
    const View view{"corner", V3f(0.1f, 0.2f, 0.3f), V3f(0.9f, 1.8f, 2.8f), V3f(0, 0, 1), 80};
    const Pictures seen(box, view, {.width = 2, .height = 2, .samples = 128}, 16);
    const std::vector<RgbD> expected(4, RgbD(1, 1, 1) / (1 - static_cast<double>(0.99f)) / pi);
    EXPECT_GT(seen.p_value(expected), false_alarm);
    EXPECT_LT(seen.p_value(expected, 0.95), false_alarm);
}

// A lamp above an otherwise empty floor: H at the floor is M times the form factor to the lamp. The camera looks
// straight down, so each pixel is the mean over a rectangle of the floor: rho M F / pi exactly.

constexpr int across = 4;  // pixels of the picture, and rectangles of the floor, per side
const Rgb floor_reflectance(0.8f, 0.4f, 0.2f);
/// The floor from (-1, -1) to (1, 1), seen from below the lamps.
const View view_of_floor{"floor", V3f(0, 0, 1), V3f(0, 0, 0), V3f(0, 1, 0), 90};

/// Faces down in the plane z = height.
struct Lamp {
    double left, front, width, depth, height;
    Rectangle rectangle() const { return {V3d(left, front, height), V3d(0, depth, 0), V3d(width, 0, 0)}; }
    void add_to(Scene& scene, std::uint32_t material, bool two_sided = false, int divisions = 1) const {
        const Rectangle r = rectangle();
        add_rectangle(scene, V3f(r.corner), V3f(r.u), V3f(r.v), material, divisions, divisions, two_sided);
    }
};

struct LampAndFloor {
    Scene scene;
    std::uint32_t light;

    explicit LampAndFloor(float exitance) {
        add_rectangle(scene, V3f(-9, -9, 0), V3f(18, 0, 0), V3f(0, 18, 0),
                      add_material(scene, floor_reflectance, Rgb(0, 0, 0)));
        light = add_material(scene, Rgb(0, 0, 0), Rgb(exitance, exitance, exitance));
    }
    /// Computes the expected pixels for lamps with these form factors from a rectangle.
    std::vector<RgbD> expected(const std::function<double(const Rectangle&)>& form_factor) const {
        const double exitance = scene.materials[light].exitance.x;
        std::vector<RgbD> result;
        for (int row = 0; row < across; ++row)
            for (int column = 0; column < across; ++column) {
                constexpr double size = 2.0 / across;
                const Rectangle seen{V3d(-1 + column * size, 1 - (row + 1) * size, 0), V3d(size, 0, 0),
                                     V3d(0, size, 0)};
                result.push_back(RgbD(floor_reflectance) * (exitance * form_factor(seen) / pi));
            }
        return result;
    }
    Pictures pictures(int samples = 64, const View& view = view_of_floor) const {
        return Pictures(scene, view, {.width = across, .height = across, .samples = samples}, 32);
    }
};

TEST(LampAboveFloor, LightsItByFormFactors) {
    const Lamp lamp{0.2, -0.6, 1.5, 1, 2};
    LampAndFloor setup(100);
    lamp.add_to(setup.scene, setup.light, false, 3);
    const auto expected = setup.expected([&](const Rectangle& r) { return form_factor(r, lamp.rectangle()); });
    const Pictures seen = setup.pictures(512);
    EXPECT_GT(seen.p_value(expected), false_alarm);
    EXPECT_LT(seen.p_value(expected, 1.04), false_alarm);
}

/// A lamp of 1 mm, which no ray hits by chance.
TEST(PathTracer, TinyBrightLampLightsByFormFactors) {
    const Lamp lamp{0.2, -0.3, 1e-3, 1e-3, 2};
    LampAndFloor setup(1e8f);
    lamp.add_to(setup.scene, setup.light);
    const auto expected = setup.expected([&](const Rectangle& r) { return form_factor(r, lamp.rectangle()); });
    const Pictures seen = setup.pictures();
    EXPECT_GT(seen.p_value(expected), false_alarm);
    EXPECT_LT(seen.p_value(expected, 1.001), false_alarm) << "little noise but that of the pixel's square";
    for (const Rendering& run : seen.runs) EXPECT_LT(run.relative_error, 0.05);
}

/// A thousand lamps; all but one are under the floor or face away from it.
TEST(PathTracer, LampsThatCannotLightCostLittlePrecision) {
    const Lamp lamp{0.2, -0.3, 0.1, 0.1, 2};
    LampAndFloor setup(1e4f);
    lamp.add_to(setup.scene, setup.light);
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 25; ++column) {
            const double x = -5 + 0.4 * column, y = -4 + 0.4 * row;
            Lamp{x, y, 0.1, 0.1, -1}.add_to(setup.scene, setup.light);
            add_rectangle(setup.scene, V3f(static_cast<float>(x), static_cast<float>(y), 3), V3f(0.1f, 0, 0),
                          V3f(0, 0.1f, 0), setup.light);
        }
    const auto expected = setup.expected([&](const Rectangle& r) { return form_factor(r, lamp.rectangle()); });
    const Pictures seen = setup.pictures();
    EXPECT_GT(seen.p_value(expected), false_alarm);
    EXPECT_LT(seen.runs[0].relative_error, 0.1) << "choosing by power alone makes it 2";
}

/// A black rectangle covers part of the lamp in its plane. The ray caster reports the smaller rectangle; both sampling
/// methods must agree with it. A duplicated lamp then lights only once.
TEST(LampAboveFloor, CoveredInItsPlaneAndDuplicated) {
    const Lamp lamp{-0.8, -0.8, 1.6, 1.6, 2}, cover{-0.3, -0.5, 0.8, 1, 2};
    LampAndFloor setup(100);
    lamp.add_to(setup.scene, setup.light);
    lamp.add_to(setup.scene, setup.light);
    cover.add_to(setup.scene, add_material(setup.scene, Rgb(0, 0, 0), Rgb(0, 0, 0)));
    const auto expected = setup.expected(
        [&](const Rectangle& r) { return form_factor(r, lamp.rectangle()) - form_factor(r, cover.rectangle()); });
    const Pictures seen = setup.pictures(256);
    EXPECT_GT(seen.p_value(expected), false_alarm);
    EXPECT_LT(seen.p_value(expected, 1.05), false_alarm);
}

/// The back of a two-sided lamp lights and is visible like the front; that of a one-sided lamp is neither.
TEST(LampAboveFloor, TwoSidedLampFacingUp) {
    const Lamp lamp{0.2, -0.6, 1.5, 1, 2};
    for (const bool two_sided : {true, false}) {
        LampAndFloor setup(100);
        const Rectangle r = lamp.rectangle();
        add_rectangle(setup.scene, V3f(r.corner), V3f(r.v), V3f(r.u), setup.light, 1, 1, two_sided);
        const Pictures seen = setup.pictures(256);
        if (two_sided)
            EXPECT_GT(seen.p_value(setup.expected([&](const Rectangle& f) { return form_factor(f, r); })), false_alarm);
        else
            EXPECT_EQ(seen.p_value(setup.expected([](const Rectangle&) { return 0.0; })), 1);
    }
}

TEST(PathTracer, ShowsLampsAsTheyEmit) {
    for (const float height : {0.5f, -0.5f})  // height of the camera: in front of the lamp and behind it
        for (const bool two_sided : {false, true}) {
            Scene scene;
            add_rectangle(scene, V3f(-9, -9, 0), V3f(18, 0, 0), V3f(0, 18, 0),
                          add_material(scene, Rgb(0, 0, 0), Rgb(3, 2, 1)), 1, 1, two_sided);
            const View view{"lamp", V3f(0, 0, height), V3f(0, 0, 0), V3f(0, 1, 0), 60};
            const Rendering seen = render(scene, RayCaster(scene), view,
                                          {.width = 3, .height = 2, .shading = Shading::path, .samples = 8});
            const bool is_seen = two_sided || height > 0;
            for (const Rgb& pixel : seen.image.pixels)
                for (int c = 0; c < 3; ++c)
                    EXPECT_FLOAT_EQ(pixel[c], is_seen ? static_cast<float>((3 - c) / pi) : 0.0f);
            EXPECT_EQ(seen.escaped_rays, is_seen ? 0 : 3 * 2 * 8);
            EXPECT_EQ(seen.relative_error, 0);
        }
}

TEST(PathTracer, WithoutLightIsBlack) {
    const Scene box = closed_box(V3f(1, 2, 3), 1, {{"wall", Rgb(0.9f, 0.9f, 0.9f), Rgb(0, 0, 0)}});
    const View view{"inside", V3f(0.1f, 0.2f, 0.3f), V3f(0.9f, 1.8f, 2), V3f(0, 0, 1), 80};
    const Rendering seen =
        render(box, RayCaster(box), view, {.width = 8, .height = 4, .shading = Shading::path, .until = 0.01});
    for (const Rgb& pixel : seen.image.pixels) EXPECT_EQ(pixel, Rgb(0, 0, 0));
    EXPECT_EQ(seen.relative_error, 0);
    EXPECT_EQ(seen.paths, 8 * 4 * 64);
    EXPECT_EQ(seen.shadow_rays, 0);
}

/// A room that exercises everything: two lamps, one of them tiny, a two-sided table and colours.
struct Room {
    Scene scene = closed_box(V3f(3, 4, 2.5f), 1,
                             {{"red", Rgb(0.7f, 0.2f, 0.1f), Rgb(0, 0, 0)},
                              {"green", Rgb(0.2f, 0.6f, 0.1f), Rgb(0, 0, 0)},
                              {"grey", Rgb(0.5f, 0.5f, 0.5f), Rgb(0, 0, 0)},
                              {"white", Rgb(0.8f, 0.8f, 0.8f), Rgb(0, 0, 0)},
                              {"floor", Rgb(0.4f, 0.3f, 0.2f), Rgb(0, 0, 0)},
                              {"ceiling", Rgb(0.8f, 0.8f, 0.8f), Rgb(0, 0, 0)}});
    View view{"room", V3f(0.2f, 0.2f, 1.6f), V3f(2, 3.5f, 0.8f), V3f(0, 0, 1), 60};
    Room() {
        Lamp{1, 1, 1, 0.5, 2.4}.add_to(scene, add_material(scene, Rgb(0.2f, 0.2f, 0.2f), Rgb(900, 800, 700)));
        Lamp{2.5, 3.5, 0.01, 0.01, 1.5}.add_to(scene, add_material(scene, Rgb(0, 0, 0), Rgb(1e6f, 1e6f, 1e6f)), true);
        Lamp{1, 2, 1, 1, 0.7}.add_to(scene, add_material(scene, Rgb(0.6f, 0.4f, 0.2f), Rgb(0, 0, 0)), true);
    }
};

/// The spread of the pictures matches their reported standard errors. In each run, the mean over the pixels of the
/// squared deviation from the mean picture, less the squared standard error, has expectation 0.
TEST(PathTracer, StandardErrorIsHonest) {
    RELEASE_ONLY();  // see SharedPicture.HasTheBitsOfOneProcess
    const Room room;
    const Pictures seen(room.scene, room.view, {.width = 16, .height = 9, .samples = 64}, 48);
    const auto p_value = [&](double factor) {
        std::vector<double> excess(seen.runs.size(), 0.0);
        const auto runs = static_cast<double>(seen.runs.size());
        for (std::size_t i = 0; i < 16 * 9; ++i)
            for (int c = 0; c < 3; ++c) {
                const std::vector<double> values = seen.values(i, c);
                double mean = 0;
                for (const double v : values) mean += v / runs;
                for (std::size_t r = 0; r < values.size(); ++r) {
                    const double error = factor * static_cast<double>(seen.runs[r].standard_error.pixels[i][c]);
                    // Relative to the pixel, so bright pixels do not dominate.
                    excess[r] +=
                        ((values[r] - mean) * (values[r] - mean) * runs / (runs - 1) - error * error) / (mean * mean);
                }
            }
        return t_test(excess, 0);
    };
    EXPECT_GT(p_value(1), false_alarm);
    EXPECT_LT(p_value(0.8), false_alarm);
    EXPECT_LT(p_value(1.25), false_alarm);
}

TEST(PathTracer, ReachesItsTargetWithoutBias) {
    RELEASE_ONLY();  // see SharedPicture.HasTheBitsOfOneProcess
    const Room room;
    const PictureOptions fixed{.width = 16, .height = 9, .samples = 512};
    PictureOptions adaptive = fixed;
    adaptive.samples = 32;
    adaptive.until = 0.08;
    const Pictures reference(room.scene, room.view, fixed, 8), seen(room.scene, room.view, adaptive, 24);
    double expected = 0;
    const std::vector<double> means = reference.means();
    for (const double m : means) expected += m / static_cast<double>(means.size());
    double variance = 0;
    for (const double m : means) variance += (m - expected) * (m - expected) / static_cast<double>(means.size() - 1);
    const double expected_error = std::sqrt(variance / static_cast<double>(means.size()));
    EXPECT_GT(t_test(seen.means(), expected, expected_error), false_alarm);
    EXPECT_LT(t_test(seen.means(), 1.02 * expected, expected_error), false_alarm);
    for (const Rendering& run : seen.runs) {
        EXPECT_LT(run.relative_error, 1.1 * adaptive.until);
        EXPECT_GT(run.relative_error, 0.3 * adaptive.until);
        EXPECT_GT(run.paths, 16 * 9 * 32);
    }
}

TEST(PathTracer, CountsRaysAndStopsAtMaxSamples) {
    const Room room;
    const Rendering seen =
        render(room.scene, RayCaster(room.scene), room.view,
               {.width = 4, .height = 3, .shading = Shading::path, .samples = 20, .max_samples = 50, .until = 1e-6});
    // Half batches are of 2 paths, the largest power of two that gives at least 8 of them: 12 whole batches.
    EXPECT_EQ(seen.paths, 4 * 3 * 48);
    EXPECT_GT(seen.rays, seen.paths + seen.shadow_rays);
    EXPECT_EQ(seen.escaped_rays, 0);
    EXPECT_FALSE(seen.interrupted);
}

/// Seen to fail when the error is 0 while pixels have a single batch and hence no spread.
TEST(PathTracer, ErrorIsUnknownUntilEveryPixelHasASpread) {
    Scene scene;
    add_rectangle(scene, V3f(-9, -9, 0), V3f(18, 0, 0), V3f(0, 18, 0), add_material(scene, Rgb(0, 0, 0), Rgb(1, 1, 1)));
    const View view{"lamp", V3f(0, 0, 1), V3f(0, 0, 0), V3f(0, 1, 0), 60};
    std::vector<double> errors;
    const Monitor monitor{[&](const Progress& progress) { errors.push_back(progress.relative_error); }};
    // Two paths a pixel: 640,000 paths, more than the interval between two reports.
    const Rendering seen = render(scene, RayCaster(scene), view,
                                  {.width = 800, .height = 400, .shading = Shading::path, .samples = 2}, monitor);
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_TRUE(std::isinf(errors[0]));
    EXPECT_EQ(errors[1], 0);
    EXPECT_EQ(seen.relative_error, 0);
}

TEST(PathTracer, StopsOnRequest) {
    const Room room;
    std::atomic<bool> stop{false};
    int reports = 0;
    const Monitor monitor{[&](const Progress& progress) {
                              ++reports;
                              EXPECT_GT(progress.rays, 0);
                              stop = true;
                          },
                          &stop};
    const Rendering seen = render(room.scene, RayCaster(room.scene), room.view,
                                  {.width = 64, .height = 64, .shading = Shading::path, .samples = 1 << 20}, monitor);
    EXPECT_EQ(reports, 1);
    EXPECT_TRUE(seen.interrupted);
    EXPECT_GT(seen.paths, 64 * 64);
    for (const Rgb& pixel : seen.image.pixels) EXPECT_GT(channel_sum(pixel), 0);
}

TEST(PathTracer, RefusesWhatMakesNoPicture) {
    const Room room;
    const RayCaster ray_caster(room.scene);
    const auto trace = [&](const PictureOptions& options) {
        return render(room.scene, ray_caster, room.view, by(Shading::path, options));
    };
    EXPECT_THROW(trace({.width = 0}), InputError);
    EXPECT_THROW(trace({.samples = 1}), InputError);
    EXPECT_THROW(trace({.until = -1}), InputError);
    EXPECT_THROW(trace({.samples = 64, .max_samples = 32, .until = 0.1}), InputError);
}

}  // namespace
}  // namespace interflect
