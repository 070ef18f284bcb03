// Pictures and measurements have the same bits for any number of threads.
#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "interflect/denoise.h"
#include "interflect/measure.h"
#include "interflect/metrics.h"
#include "interflect/preview.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/threads/on_threads.h"

namespace interflect {
namespace {

using namespace testing_support;

/// A room with a lamp behind a screen, and its light.
struct Room {
    Scene scene = [] {
        Scene room = furnished_room();
        room.luminaires.push_back({"lamp", 0, PointLight{{0.5f, 0.6f, 2.2f}, Rgb(30)}});
        return room;
    }();
    RayCaster ray_caster{scene};
    Solution solution = [&] {
        SolveOptions options{.method = find_method("hsrr")};
        options.limits.rays = 30'000;
        return solve(scene, ray_caster, options);
    }();

    Rendering picture(const PictureOptions& options) const {
        return needs_solution(options.shading) ? render(scene, solution, ray_caster, into_the_corner, options)
                                               : render(scene, ray_caster, into_the_corner, options);
    }
};

const Room& room() {
    static const Room room;
    return room;
}

auto bits_of(const Rendering& r) { return std::tuple(r.image.pixels, r.standard_error.pixels, r.rays, r.paths); }

class SameBitsOfPictures : public testing::TestWithParam<Shading> {
  protected:
    const PictureOptions options{.width = 48, .height = 27, .shading = GetParam(), .samples = 4, .light_walks = 2000};
};
INSTANTIATE_TEST_SUITE_P(Shadings, SameBitsOfPictures,
                         testing::Values(Shading::flat, Shading::smooth, Shading::hybrid, Shading::gather,
                                         Shading::path, Shading::instant),
                         [](const auto& test) { return label(test.param); });

TEST_P(SameBitsOfPictures, WithAFixedNumberOfSamples) {
    expect_same_bits([&] { return bits_of(room().picture(options)); });
}

TEST_P(SameBitsOfPictures, UntilAnErrorIsReached) {
    PictureOptions until = options;
    until.until = 0.1;
    until.max_samples = 16;
    expect_same_bits([&] { return bits_of(room().picture(until)); });
}

TEST(SameBitsOfPreviews, InAQuarterOfTheSize) {
    const PictureOptions options{.width = 64, .height = 36};
    expect_same_bits([&] {
        const Rendering r = preview(room().scene, room().solution, room().ray_caster, into_the_corner, options,
                                    {.reduction = 4, .denoiser = Denoiser::own});
        return std::tuple(r.image.pixels, r.rays);
    });
}

TEST(SameBitsOfFilteredPictures, ByTheOwnFilter) {
    const Rendering rendering = room().picture({.width = 64, .height = 36, .shading = Shading::gather, .samples = 4});
    expect_same_bits([&] { return denoise(rendering.layers, Denoiser::own).image.pixels; });
}

TEST(SameBitsOfQuantities, OfElements) {
    const PictureOptions options{.width = 64, .height = 36, .samples = 4};
    expect_same_bits([&] {
        const Room& r = room();
        const auto drawn =
            draw_quantity(r.scene, r.solution, r.ray_caster, into_the_corner, ElementQuantity::irradiance, options);
        return std::tuple(drawn.values.pixels, drawn.shown.pixels);
    });
}

TEST(SameBitsOfDifferences, OfPictures) {
    const Image few = room().picture({.width = 64, .height = 36, .shading = Shading::path, .samples = 2}).image;
    const Image many = room().picture({.width = 64, .height = 36, .shading = Shading::path, .samples = 16}).image;
    expect_same_bits([&] {
        const ImageDifference difference = compare(few, many);
        return std::tuple(difference.flip_map.pixels, difference.perceptual_distance);
    });
}

TEST(SameBitsOfMeasurements, AtPoints) {
    const std::vector<MeasuringPoint> points(40, {.position = {0.5, 0.5, 0.9}});
    for (const Shading shading : {Shading::gather, Shading::path})
        expect_same_bits([&] {
            std::vector<Rgb> measured;
            for (const MeasuredIrradiance& m : measure_irradiance(room().scene, &room().solution, room().ray_caster,
                                                                  points, {.shading = shading, .samples = 32}))
                measured.insert(measured.end(), {m.direct, m.indirect, m.standard_error});
            return measured;
        });
}

TEST(SameBitsOfMeasurements, OfProbes) {
    expect_same_bits([] {
        std::vector<Rgb> measured;
        for (const IrradianceProbe& probe :
             irradiance_probes(room().scene, room().solution, room().ray_caster, {.spacing = 1, .rays = 256}).probes)
            measured.insert(measured.end(), probe.coefficients.begin(), probe.coefficients.end());
        return measured;
    });
}

}  // namespace
}  // namespace interflect
