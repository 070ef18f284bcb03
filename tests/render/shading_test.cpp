#include "interflect/shading.h"

#include <gtest/gtest.h>

#include <string>

#include "interflect/export.h"
#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

/// Returns the message of the InputError; empty without one.
template <class Call>
std::string fault_of(const Call& call) {
    try {
        call();
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Shading, HasALabelOfEachValue) {
    EXPECT_STREQ(label(Shading::flat), "flat");
    EXPECT_STREQ(label(Shading::smooth), "smooth");
    EXPECT_STREQ(label(Shading::hybrid), "hybrid");
    EXPECT_STREQ(label(Shading::gather), "gather");
    EXPECT_STREQ(label(Shading::path), "path");
    EXPECT_STREQ(label(Shading::instant), "instant");
    for (const char* text : shading_labels) EXPECT_STREQ(label(find_shading(text, &DefaultSamples::pixel)), text);
}

TEST(Shading, HasDefaultsForItsUsesOnly) {
    EXPECT_EQ(available_shadings(&DefaultSamples::pixel).size(), shading_labels.size());
    EXPECT_EQ(available_shadings(&DefaultSamples::texel),
              (std::vector{Shading::smooth, Shading::hybrid, Shading::gather}));
    EXPECT_EQ(available_shadings(&DefaultSamples::vertex), available_shadings(&DefaultSamples::texel));
    EXPECT_EQ(available_shadings(&DefaultSamples::point), (std::vector{Shading::gather, Shading::path}));
    EXPECT_EQ(require_samples(Shading::hybrid, &DefaultSamples::vertex), 64);
    EXPECT_EQ(require_samples(Shading::hybrid, &DefaultSamples::vertex, 5), 5);
}

TEST(Shading, MessagesListTheAvailableOnes) {
    EXPECT_EQ(fault_of([] { find_shading("phong", &DefaultSamples::point); }),
              "shading: expected gather or path, found 'phong'");
    EXPECT_EQ(fault_of([] { require_samples(Shading::path, &DefaultSamples::texel); }),
              "shading: expected smooth, hybrid or gather, found 'path'");
}

/// Each function refuses the shadings that are not available for it.
TEST(Shading, IsRefusedWhereItHasNoUse) {
    const Scene scene = closed_box({1, 1, 1}, 1, {Material{"", Rgb(0.5f), Rgb(1)}});
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 1000}});
    const View view{"inside", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}};
    const std::vector<MeasuringPoint> points{{{0.5, 0.5, 0.5}}};
    for (const Shading shading : available_shadings(&DefaultSamples::pixel)) {
        const auto draw = [&] { render(scene, ray_caster, view, {.width = 2, .height = 2, .shading = shading}); };
        EXPECT_EQ(fault_of(draw),
                  needs_solution(shading) ? std::string(label(shading)) + " shading needs a solution" : "");
    }
    for (const Shading shading : {Shading::flat, Shading::smooth, Shading::hybrid, Shading::instant})
        EXPECT_EQ(fault_of([&] { measure_irradiance(scene, &solution, ray_caster, points, {.shading = shading}); }),
                  std::string("shading: expected gather or path, found '") + label(shading) + "'");
    EXPECT_EQ(fault_of([&] { measure_irradiance(scene, nullptr, ray_caster, points); }),
              "gather shading needs a solution");
    for (const Shading shading : {Shading::flat, Shading::path, Shading::instant})
        for (const bool has_lightmap : {false, true}) {
            ExportOptions options;
            options.bake.shading = shading;
            if (has_lightmap) options.lightmap.emplace();
            EXPECT_EQ(fault_of([&] { export_solution("refused.glb", scene, solution, options); }),
                      std::string("shading: expected smooth, hybrid or gather, found '") + label(shading) + "'");
        }
}

/// A picture without options equals the picture with the default options.
TEST(Shading, DefaultPictureIsHybrid) {
    const Scene scene = closed_box({1, 1, 1}, 1, {Material{"", Rgb(0.5f), Rgb(1)}});
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 1000}});
    const View view{"inside", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}};
    PictureOptions options{.width = 8, .height = 6};
    const Rendering picture = render(scene, solution, ray_caster, view, options);
    options.shading = Shading::hybrid;
    options.samples = 32;
    EXPECT_EQ(picture.image.pixels, render(scene, solution, ray_caster, view, options).image.pixels);
    EXPECT_TRUE(picture.layers.is_indirect_interpolated);
}

}  // namespace
}  // namespace interflect
