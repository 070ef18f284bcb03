// `ies` in MGF files, and luminaires added to those of a scene's file.
//
// Seen to fail when the transform around an `ies` does not turn it, when a mirror image keeps its sides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "interflect/core.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/mgf/write_mgf.h"
#include "interflect/formats/photometry/write_ies.h"
#include "interflect/load.h"
#include "interflect/luminaires/illumination.h"
#include "tests/support/scenes/photometry_files.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::HasSubstr;

const std::string face = "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv d =\n p 1 1 0\nf a b d\n";

class MgfLuminaires : public testing::Test {
  protected:
    /// Brightest towards C0, then C90.
    MgfLuminaires() {
        lamp = folder.write("lamp.ies",
                            IesText{.lumens = 500,
                                    .vertical = {0, 90},
                                    .horizontal = {0, 90, 180, 270, 360},
                                    .intensity =
                                        [](double v, double h) {
                                            return v == 0 ? 50 : h == 90 ? 200 : h == 180 ? 100 : h == 270 ? 70 : 300;
                                        }}
                                .str());
    }
    Scene read(const std::string& entities) { return load_scene(folder.write("scene.mgf", face + entities)); }
    static const MeasuredLight& light(const Scene& scene, std::size_t i = 0) {
        return std::get<MeasuredLight>(scene.luminaires.at(i).kind);
    }
    /// Returns the irradiance at a distance of 1 m.
    static float intensity(const Scene& scene, const V3f& towards, std::size_t i = 0) {
        return illumination(scene.luminaires.at(i), light(scene, i).position + towards.normalized()).irradiance.y;
    }
    const TemporaryFolder folder;
    std::filesystem::path lamp;
};

TEST_F(MgfLuminaires, ShineDownWithC0AlongX) {
    const Scene scene = read("ies lamp.ies\n");
    EXPECT_EQ(light(scene).position, V3f(0));
    EXPECT_NEAR(intensity(scene, {0, 0, -1}), 50, 1e-3);
    EXPECT_NEAR(intensity(scene, {1, 0, -1e-4f}), 300, 0.1);
    EXPECT_NEAR(intensity(scene, {0, 1, -1e-4f}), 200, 0.1);
    EXPECT_NEAR(intensity(scene, {-1, 0, -1e-4f}), 100, 0.1);
    EXPECT_EQ(intensity(scene, {0, 0, 1}), 0);
    EXPECT_EQ(scene.luminaires[0].name, "lamp-1");
    EXPECT_EQ(scene.files.back(), lamp.string());
}

TEST_F(MgfLuminaires, AreMovedAndTurnedButNotScaled) {
    const Scene scene = read("o hall\nxf -t 0 0 5 -s 2\nies lamp.ies -m 0.5 -rz 90 -t 1 2 0\nxf\no\n");
    EXPECT_LT((light(scene).position - V3f(2, 4, 10)).length(), 1e-5f);
    EXPECT_NEAR(intensity(scene, {0, 0, -1}), 25, 1e-3);
    EXPECT_NEAR(intensity(scene, {0, 1, -1e-4f}), 150, 0.1) << "C0 is turned from x to y";
    EXPECT_NEAR(intensity(scene, {-1, 0, -1e-4f}), 100, 0.1);
    EXPECT_EQ(scene.objects[scene.luminaires[0].object], "hall");
    const Scene upright = read("xf -rx 90\nies lamp.ies\nxf\n");
    EXPECT_NEAR(intensity(upright, {0, 1, 0}), 50, 1e-3) << "-z becomes y";
    EXPECT_NEAR(intensity(upright, {0, 1e-4f, 1}), 200, 0.1) << "y becomes z";
}

/// A box of 0.3 m, 1 mm below its place, along its own axis. Transforms do not scale it.
TEST_F(MgfLuminaires, AreMountedByTheirTop) {
    folder.write("box.ies", IesText{.opening = "0.2 0.2 0.3"}.str());
    const Scene scene =
        read("xf -s 2\nies box.ies -top -t 1 2 3\nxf\nies box.ies -rx 90 -t 1 2 3\nies box.ies -top -rx 90\n");
    EXPECT_LT((light(scene).position - V3f(2, 4, 6 - 0.151f)).length(), 1e-5f);
    EXPECT_LT((light(scene, 1).position - V3f(1, 2, 3)).length(), 1e-5f);
    EXPECT_LT((light(scene, 2).position - V3f(0, 0.151f, 0)).length(), 1e-5f) << "-z becomes y";
    const std::vector<PlacedLuminaire> placed{
        {.file = folder.path() / "box.ies", .position = {1, 2, 3}, .aim = Imath::V3d(9, 2, 3), .by_top = true}};
    const Scene added = load_scene(folder.write("dark.mgf", face), {}, placed);
    EXPECT_LT((light(added).position - V3f(1.151f, 2, 3)).length(), 1e-5f);
}

TEST_F(MgfLuminaires, AreMirrored) {
    const Scene scene = read("ies lamp.ies -my\n");
    EXPECT_NEAR(intensity(scene, {1, 0, -1e-4f}), 300, 0.1);
    EXPECT_NEAR(intensity(scene, {0, -1, -1e-4f}), 200, 0.1);
    EXPECT_NEAR(intensity(scene, {0, 1, -1e-4f}), 70, 0.1);
}

TEST_F(MgfLuminaires, AreWhiteUnlessAColourIsNamed) {
    const Scene scene = read("c red =\n cxy .6 .35\nies lamp.ies -c red -t 0 0 3\nies lamp.ies\n");
    EXPECT_GT(light(scene).factor.x, 2 * light(scene).factor.z);
    EXPECT_NEAR(luminance(light(scene).factor), 1, 1e-5);
    EXPECT_LT((light(scene, 1).factor - Rgb(1)).length(), 1e-5f);
}

TEST_F(MgfLuminaires, InArraysShareTheirWeb) {
    const Scene scene = read("ies lamp.ies -t 0 0 3 -a 2 -t 2 0 0 -a 3 -t 0 5 0\n");
    ASSERT_EQ(scene.luminaires.size(), 6u);
    EXPECT_EQ(light(scene, 5).position, V3f(2, 10, 3));
    EXPECT_EQ(light(scene, 5).web, light(scene).web);
    EXPECT_THROW(read("ies lamp.ies -a 1000000000 -t 1 0 0\n"), InputError);
}

TEST_F(MgfLuminaires, FaultsNameTheScenesLine) {
    const auto expect_fault = [&](const std::string& entities, const std::string& message) {
        try {
            read(entities);
            FAIL() << entities;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr("scene.mgf:8: "));
            EXPECT_THAT(e.what(), HasSubstr(message));
        }
    };
    folder.write("bad.ies", "IESNA91\n");
    expect_fault("ies no.ies\n", "no.ies: no such file");
    expect_fault("ies bad.ies\n", "bad.ies:1: expected a line that begins with TILT=");
    expect_fault("ies lamp.txt\n", "no format of measured light");
    expect_fault("ies lamp.ies -m -1\n", "'-1' must not be negative");
    expect_fault("ies lamp.ies -c green\n", "colour 'green' is not defined");
    expect_fault("ies lamp.ies -q 1\n", "'-q' is no transform");
    expect_fault("ies\n", "expected 'ies file");
}

TEST_F(MgfLuminaires, ComeBackAsTheyWereWritten) {
    const Scene scene = read(
        "c red =\n cxy .6 .35\nies lamp.ies -c red -m 0.3 -mx -rx 20 -ry 130 -rz -70 -t 1 2 3\n"
        "ies lamp.ies -ry 90\n");
    const auto path = folder.path() / "written.mgf";
    const std::vector<std::string> files = web_files(scene, path);
    ASSERT_EQ(files.size(), 1u);
    write_ies(*photometric_webs(scene)[0], folder.path() / files[0]);
    write_mgf(scene, path, {}, files);
    const Scene back = load_scene(path);
    for (std::size_t i = 0; i < 2; ++i)
        for (const V3f& d : {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1), V3f(-1, 0.3f, 0.2f), V3f(0.3f, -1, -0.5f)})
            EXPECT_NEAR(intensity(back, d, i), intensity(scene, d, i), 0.01) << i;
    EXPECT_EQ(light(back).position, light(scene).position);
    std::ostringstream out;
    EXPECT_THROW(write_mgf(scene, out), std::runtime_error);
}

TEST_F(MgfLuminaires, ArePlacedBesideThoseOfTheFile) {
    const auto scene_file = folder.write("dark.mgf", face);
    EXPECT_EQ(load_scene(scene_file).warnings.entries().size(), 1u) << "no light";
    const PlacedLuminaire placed{.file = lamp,
                                 .position = {1, 2, 3},
                                 .aim = Imath::V3d(1, 2, 9),
                                 .turn = 90,
                                 .lumens = 1500,
                                 .maintenance = 0.8};
    const std::vector<PlacedLuminaire> both{{.file = lamp, .position = {0, 0, 2}}, placed};
    const Scene scene = load_scene(scene_file, {}, both);
    EXPECT_TRUE(scene.warnings.entries().empty());
    ASSERT_EQ(scene.luminaires.size(), 2u);
    EXPECT_NEAR(intensity(scene, {1, 0, -1e-4f}), 300, 0.1);
    EXPECT_NEAR(intensity(scene, {0, 0, 1}, 1), 50 * 3 * 0.8, 1e-2) << "upwards";
    EXPECT_EQ(intensity(scene, {0, 0, -1}, 1), 0);
    EXPECT_NEAR(intensity(scene, {0, -1, 1e-4f}, 1), 300 * 2.4, 0.5) << "turned about an axis that points up";
    EXPECT_EQ(light(scene).web, light(scene, 1).web);
    const std::vector<PlacedLuminaire> impossible{{.file = lamp, .position = {1, 1, 1}, .aim = Imath::V3d(1, 1, 1)}};
    EXPECT_THROW(load_scene(scene_file, {}, impossible), InputError);
}

}  // namespace
}  // namespace interflect
