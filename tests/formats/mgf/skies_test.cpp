// `light sky` and `light environment` in MGF files, and daylight added to the lights of a scene's file.
//
// Seen to fail when east and west are exchanged in all skies, when azimuths count the other way, when the ground is
// black, when a dome's integral lacks a factor of pi.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/mgf/write_mgf.h"
#include "interflect/load.h"
#include "interflect/luminaires/skies/skies.h"
#include "interflect/scene/sky/environment_maps.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::HasSubstr;

using std::numbers::pi;
const std::string any_face = "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv d =\n p 1 1 0\nf a b d\n";  // 7 lines
const std::string sunlight = "v up =\n n 0 0 1\nv s =\n n -0.6 0 -0.8\n";  // the sun is in the east, 53.13 degrees high

class MgfSkies : public testing::Test {
  protected:
    /// Four texels a row: the back (south), west, north ...; those of the upper half are bright and all different.
    MgfSkies() {
        map = folder.path() / "map.exr";
        write_texture(
            map,
            *image_of(4, 2, {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7}, {8, 8, 8}}));
    }
    Scene read(const std::string& entities) { return load_scene(folder.write("scene.mgf", any_face + entities)); }
    static const SkyDome& dome(const Scene& scene) { return std::get<SkyDome>(scene.luminaires.at(0).kind); }
    static double seen(const Scene& scene, const V3f& direction) {
        return static_cast<double>(Skies(scene).radiance_with_suns(direction.normalized()).y);
    }
    void expect_fault(const std::string& line, const std::string& message) {
        try {
            read(sunlight + line + "\n");
            ADD_FAILURE() << line;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr("scene.mgf:12: "));
            EXPECT_THAT(e.what(), HasSubstr(message));
        }
    }
    const TemporaryFolder folder;
    std::filesystem::path map;
};

TEST_F(MgfSkies, OfTheCieHaveTheirIlluminanceColourAndGround) {
    const Scene scene = read("o outside\nc\n cct 8000\nlight sky cie-16 9000 0.2\no\n");
    EXPECT_NEAR(luminance(dome(scene).irradiance), 9000, 0.1);
    EXPECT_GT(dome(scene).irradiance.z, 1.1f * dome(scene).irradiance.x);
    EXPECT_EQ(dome(scene).ground, 0.2f);
    EXPECT_EQ(scene.luminaires[0].name, "sky-dome-1");
    EXPECT_EQ(scene.objects[scene.luminaires[0].object], "outside");
    // Moon and Spencer: luminance of the zenith is 9 / (7 pi) of the illuminance.
    EXPECT_NEAR(luminance(Skies(scene).radiance_with_suns({0, 0, 1})), 9000 * 9 / (7 * pi), 1);
    EXPECT_NEAR(luminance(Skies(scene).radiance_with_suns({0, 1, 0.0001f})), 9000 * 3 / (7 * pi), 1);
    EXPECT_NEAR(luminance(Skies(scene).radiance_with_suns({0, 0, -1})), 9000 * 0.2 / pi, 0.1);
}

TEST_F(MgfSkies, HaveTheirSunWhereTheVertexSays) {
    const Scene scene = read(sunlight + "light sky clear s 10000\n");
    EXPECT_LT((dome(scene).sun - V3f(0.6f, 0, 0.8f)).length(), 1e-6f);
    EXPECT_GT(seen(scene, {0.6f, 0, 0.8f}), 3 * seen(scene, {-0.6f, 0, 0.8f}));
    EXPECT_EQ(dome(scene).ground, 0);
}

TEST_F(MgfSkies, AreTurnedButNotScaled) {
    const Scene scene = read(sunlight + "xf -rx -90 -s 5\nlight sky cie-16 9000\nlight sky clear s 9000\nxf\n");
    for (const Luminaire& luminaire : scene.luminaires)
        EXPECT_LT((std::get<SkyDome>(luminaire.kind).zenith - V3f(0, 1, 0)).length(), 1e-6f) << "z becomes y";
    EXPECT_LT((std::get<SkyDome>(scene.luminaires[1].kind).sun - V3f(0.6f, 0.8f, 0)).length(), 1e-6f);
    EXPECT_NEAR(luminance(dome(scene).irradiance), 9000, 0.1);
}

TEST_F(MgfSkies, ByPerezBringTheirSun) {
    const Scene scene = read(sunlight + "light sky perez s 850 80 0.2\n");
    const ModelledDaylight expected = perez_daylight(850, 80, std::asin(0.8) * 180 / pi);
    ASSERT_EQ(scene.luminaires.size(), 2u);
    EXPECT_NEAR(luminance(dome(scene).irradiance), expected.sky_illuminance, 0.1);
    const auto& sun = std::get<DirectionalLight>(scene.luminaires[1].kind);
    EXPECT_NEAR(luminance(sun.irradiance), expected.sun_illuminance, 1);
    EXPECT_EQ(sun.diameter, sun_diameter);
    EXPECT_NEAR(luminance(Skies(scene).radiance_with_suns({0, 0, -1})),
                0.2 / pi * (expected.sky_illuminance + 0.8 * expected.sun_illuminance), 1);
    EXPECT_EQ(read(sunlight + "light sky perez s 0 80\n").luminaires.size(), 1u) << "no sun without direct light";
}

TEST_F(MgfSkies, OfSixNumbersAreTheModelWithThem) {
    const Scene scene = read(sunlight + "light sky model s 5000 0.1 -1 -0.32 10 -3 0.45 0\n");
    const Scene clear = read(sunlight + "light sky clear s 5000 0.1\n");
    for (const V3f& d : {V3f(0, 0, 1), V3f(1, 0, 0.3f), V3f(-1, 2, 1), V3f(0, 0, -1)})
        EXPECT_NEAR(seen(scene, d), seen(clear, d), 1e-3);
}

TEST_F(MgfSkies, MayBeTheSunsDisc) {
    const Scene scene = read(sunlight + "light directional s 80000 0.533\n");
    const double disc = 80'000 / (pi * std::pow(std::sin(0.533 / 2 * pi / 180), 2));
    EXPECT_NEAR(seen(scene, {0.6f, 0, 0.8f}) / disc, 1, 1e-3);
    EXPECT_EQ(seen(scene, {0.6f, 0.01f, 0.8f}), 0);
    expect_fault("light directional s 1 91", "has a disc of 91 degrees; expected 0 to 90");
}

/// The middle of the image is north (y), with east to its right. A rotation turns it clockwise as seen from above.
TEST_F(MgfSkies, MayBeAnImage) {
    const V3f from_back(-0.1f, -1, 0.1f), west(-1, -0.1f, 0.1f), north_west(-0.1f, 1, 0.1f), north_east(0.1f, 1, 0.1f);
    const Scene scene = read("light environment map.exr\n");
    EXPECT_NEAR(seen(scene, from_back), 1, 1e-5);
    EXPECT_NEAR(seen(scene, west), 1, 1e-5);
    EXPECT_NEAR(seen(scene, north_west), 2, 1e-5);
    EXPECT_NEAR(seen(scene, north_east), 3, 1e-5);
    EXPECT_NEAR(seen(scene, {1, -0.1f, 0.1f}), 4, 1e-5);
    EXPECT_NEAR(seen(scene, {0.1f, 1, -0.1f}), 7, 1e-5);
    EXPECT_EQ(scene.files.back(), map.string());
    EXPECT_EQ(scene.luminaires[0].name, "environment-1");
    const Scene turned = read("light environment map.exr 90 0.5\n");
    EXPECT_NEAR(seen(turned, {1, -0.1f, 0.1f}), 1.5, 1e-5) << "what was right of north is right of east";
    const Scene tilted = read("xf -rx -90\nlight environment map.exr\nxf\n");
    EXPECT_NEAR(seen(tilted, {0.1f, 0.1f, -1}), 3, 1e-5) << "y, north, becomes -z";
    const Scene shared = read("xf -a 3 -rz 30\nlight environment map.exr\nxf\n");
    EXPECT_EQ(environment_maps(shared).size(), 1u) << "read once";
}

TEST_F(MgfSkies, FaultsNameTheScenesLine) {
    folder.write("bad.hdr", "not an image");
    folder.write("small.png", "\x89PNG");
    expect_fault("light sky blue 5", "unknown sky 'blue'");
    expect_fault("light sky cie-17 5", "unknown sky 'cie-17'");
    expect_fault("light sky overcast", "expected 'light sky overcast illuminance [ground]', found 1 arguments");
    expect_fault("light sky clear s", "expected 'light sky clear vertex illuminance [ground]'");
    expect_fault("light sky clear a 5", "needs a normal");
    expect_fault("light sky clear s -5", "'-5' must not be negative");
    expect_fault("light sky overcast 5 -1", "'-1' must not be negative");
    expect_fault("light sky perez s 800", "expected 'light sky perez vertex direct-normal");
    expect_fault("light sky perez s 2000 100", "irradiances of 2000 W/m2");
    expect_fault("light sky model s 5 0 1 -1 0 -1 0",
                 "expected 'light sky model vertex illuminance ground a b c d e g'");
    expect_fault("light sky model s 5 0 1 1 0 -1 0 0", "infinitely bright at the horizon");
    expect_fault("light sky model s 5 0 -3 0 0 -1 0 0", "has no luminance");
    expect_fault("light sky overcast 1e12", "is too bright");
    expect_fault("light sky clear up 5", "has its sun below the horizon");
    expect_fault("light sky perez up 800 100", "a sun at -90 degrees");
    expect_fault("light environment none.hdr", "none.hdr: no such file");
    expect_fault("light environment bad.hdr", "bad.hdr: cannot read this image");
    expect_fault("light environment small.png", "expected .exr or .hdr");
    expect_fault("light environment map.exr north", "'north' is not a finite number");
    expect_fault("light environment map.exr 0 -1", "'-1' must not be negative");
    expect_fault("light environment", "expected 'light");
}

TEST_F(MgfSkies, AreFew) {
    std::string lines;
    for (std::size_t i = 0; i < max_skies; ++i) lines += "light sky overcast 1\n";
    EXPECT_EQ(read(lines + "light sky 5\n").luminaires.size(), max_skies + 1) << "uniform ones do not count";
    EXPECT_THROW(read(lines + "light sky overcast 1\n"), InputError);
    EXPECT_THROW(read("xf -a 9 -rz 1\nlight environment map.exr\nxf\n"), InputError);
}

TEST_F(MgfSkies, ComeBackAsTheyWereWritten) {
    const Scene scene = read(sunlight +
                             "c\n cct 5000\nxf -rx -60 -ry 20\nlight sky clear s 9000 0.3\nlight sky overcast 400\nxf\n"
                             "xf -rz 33 -rx 80\nlight environment map.exr 30 2\nxf\nlight directional s 70000 0.6\n");
    const auto path = folder.path() / "written.mgf";
    const std::vector<std::string> files = map_files(scene, path);
    ASSERT_EQ(files, std::vector<std::string>{"written.map-0.exr"});
    write_texture(folder.path() / files[0], *environment_maps(scene)[0]);
    write_mgf(scene, path, {}, {}, files);
    const Scene back = load_scene(path);
    ASSERT_EQ(back.luminaires.size(), scene.luminaires.size());
    for (std::size_t i = 0; i < scene.luminaires.size(); ++i) {
        Scene one = scene, other = back;
        one.luminaires = {scene.luminaires[i]}, other.luminaires = {back.luminaires[i]};
        for (const V3f& d : {V3f(0.6f, 0, 0.8f), V3f(1, 0.2f, 0.1f), V3f(0.2f, 1, 0.1f), V3f(0, 0.1f, 1),
                             V3f(-1, 0.3f, 0.2f), V3f(0.3f, -1, -0.5f)})
            EXPECT_NEAR(seen(other, d), seen(one, d), 1e-3 * seen(one, d) + 1e-3) << i << " " << d;
    }
    EXPECT_THROW(write_mgf(scene, path), std::runtime_error) << "the map has no file";
}

// ---- Added to a scene's own lights

class PlacedDaylight : public MgfSkies {
  protected:
    Scene placed(const Daylight& daylight) { return load_scene(folder.write("scene.mgf", any_face), {}, {}, daylight); }
};

TEST_F(PlacedDaylight, HasItsSunByAzimuthAndAltitude) {
    const Scene scene = placed({.sun = Daylight::Sun{90, 30, 50'000}});
    ASSERT_EQ(scene.luminaires.size(), 1u);
    const auto& sun = std::get<DirectionalLight>(scene.luminaires[0].kind);
    EXPECT_LT((sun.direction - V3f(-std::sqrt(0.75f), 0, -0.5f)).length(), 1e-6f) << "90 degrees is east";
    EXPECT_EQ(sun.irradiance, Rgb(50'000));
    EXPECT_EQ(sun.diameter, sun_diameter);
    EXPECT_EQ(scene.luminaires[0].name, "sun-1");
    const Scene upright = placed({.sun = Daylight::Sun{0, 45, 1}, .zenith = {0, 2, 0}});
    EXPECT_LT((std::get<DirectionalLight>(upright.luminaires[0].kind).direction - V3f(0, -1, 1).normalized()).length(),
              1e-6f)
        << "where y is up, north is -z";
}

/// IES: with h = 30 degrees, 127500 exp(-0.21 / 0.5) and 800 + 15500 sqrt(0.5) under a clear sky, and so on.
TEST_F(PlacedDaylight, HasUsualIlluminances) {
    struct Case {
        int type;
        double sky, sun;
    };
    for (const Case& c : {Case{12, 11760.15511, 83773.47}, Case{7, 22800, 25741.8}, Case{1, 10800, 0}}) {
        EXPECT_NEAR(usual_sky_illuminance(c.type, 30), c.sky, 1e-2);
        EXPECT_NEAR(usual_sun_illuminance(c.type, 30), c.sun, 0.1);
        const Scene scene = placed({.sun = Daylight::Sun{180, 30, {}}, .cie_sky = Daylight::CieSky{c.type, {}}});
        const SkyDome& sky = std::get<SkyDome>(scene.luminaires.back().kind);
        EXPECT_NEAR(sky.irradiance.y, c.sky, 1e-2);
        EXPECT_LT((sky.sun - V3f(0, -std::sqrt(0.75f), 0.5f)).length(), 1e-6f);
        EXPECT_EQ(scene.luminaires.size(), c.sun > 0 ? 2u : 1u);
    }
    EXPECT_EQ(usual_sky_illuminance(1, {}), 10'000);
}

TEST_F(PlacedDaylight, LightsItsGround) {
    const Scene scene = placed(
        {.sun = Daylight::Sun{180, 30, 60'000}, .cie_sky = Daylight::CieSky{12, 10'000}, .ground_reflectance = 0.25});
    EXPECT_NEAR(seen(scene, {1, 1, -1}), 0.25 / pi * (10'000 + 60'000 * 0.5), 0.1);
    const Scene by_perez = placed(
        {.sun = Daylight::Sun{180, 30, {}}, .perez_sky = Daylight::PerezSky{650, 120}, .ground_reflectance = 0.25});
    const ModelledDaylight expected = perez_daylight(650, 120, 30);
    EXPECT_NEAR(seen(by_perez, {1, 1, -1}), 0.25 / pi * (expected.sky_illuminance + expected.sun_illuminance * 0.5),
                0.1);
}

TEST_F(PlacedDaylight, MayBeAnImage) {
    const Scene scene = placed({.environment = Daylight::Environment{map, 90, 0.5}});
    EXPECT_NEAR(seen(scene, {1, -0.1f, 0.1f}), 1.5, 1e-5);
    EXPECT_EQ(scene.files.back(), map.string());
}

TEST_F(PlacedDaylight, RefusesWhatCannotBe) {
    const auto expect_refused = [&](const Daylight& daylight, const std::string& message) {
        try {
            placed(daylight);
            ADD_FAILURE() << message;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr(message));
        }
    };
    expect_refused({.cie_sky = Daylight::CieSky{12, {}}}, "a sky of CIE type 12 needs a sun");
    expect_refused({.perez_sky = Daylight::PerezSky{100, 100}}, "a sky by Perez needs a sun");
    expect_refused({.sun = Daylight::Sun{0, -5, {}}}, "expected an altitude above 0 to 90");
    expect_refused({.sun = Daylight::Sun{0, 5, -1}}, "negative");
    expect_refused({.cie_sky = Daylight::CieSky{1, 5}, .zenith = {0, 0, 0}}, "the zenith has no direction");
    expect_refused({.environment = Daylight::Environment{"none.exr"}}, "none.exr: no such file");
}

}  // namespace
}  // namespace interflect
