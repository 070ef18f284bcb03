// Images of the resolution (LightmapContent::density). tests/python/lit_files_test.py draws an unsolved file.
#include <gtest/gtest.h>

#include "interflect/plots.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace lightmap_testing;

/// A floor of 30 x 30 m at 2 texels a metre, which an image of 64 x 64 texels reduces, and a board of 1 x 1 m at 16.
/// Seen to fail if a chart has the colour of the requested density, or squares of one colour.
TEST(LightmapDensity, IsTheColourOfSquares) {
    Scene scene;
    const std::uint32_t material = testing_support::add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {"", "floor", "board"};
    const PatchIndex floor = testing_support::add_rectangle(scene, V3f(0), V3f(30, 0, 0), V3f(0, 30, 0), material);
    const PatchIndex board = testing_support::add_rectangle(scene, V3f(0, 0, 1), V3f(1, 0, 0), V3f(0, 1, 0), material);
    scene.patches[floor].object = 1;
    scene.patches[board].object = 2;
    ExportOptions options = at(2);
    options.lightmap->content = LightmapContent::density;
    options.lightmap->densities = {{"board", 16}};
    options.lightmap->max_size = 64;
    Warnings warnings;
    options.warnings = &warnings;
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, 1), options);

    ASSERT_EQ(lightmap.densities.size(), 2);
    const ObjectDensity &of_floor = lightmap.densities[0], &of_board = lightmap.densities[1];
    EXPECT_EQ(of_floor.object, "floor");
    EXPECT_EQ(of_floor.requested, 2);
    EXPECT_NEAR(of_floor.obtained, 59 / 30.0, 1e-4);  // 60 texels and two gutters
    EXPECT_NEAR(of_board.obtained, 16, 1e-4);
    ASSERT_EQ(warnings.entries().size(), 1);
    EXPECT_EQ(warnings.entries()[0].where, "floor");

    for (const LightmapChart& chart : lightmap.charts) {
        const Image& image = lightmap.images[static_cast<std::size_t>(chart.page)];
        const float octaves = chart.object == 1 ? std::log2(59 / 60.0f) : 3;
        const Rgb colour = false_colour(0.5f + octaves / 4);
        for (int k = 0; k < 2; ++k) {
            const Rgb found = image.at(chart.left - 2 + 8 * k, chart.top - 2);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], colour[c] * (k == 0 ? 1 : 0.5f), 1e-3f);
        }
    }
}

}  // namespace
}  // namespace interflect
