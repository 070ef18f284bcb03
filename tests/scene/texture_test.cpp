// Textures: positions of texels, and faults of scenes.
//
// Seen to fail when rows are counted from below, and when centres are shifted by half a texel.
#include "interflect/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using testing::HasSubstr;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Three columns and two rows: the upper row is 1 2 3, the lower 4 5 6.
Texture numbered() {
    Texture texture{"numbers.png", 3, 2, {}};
    for (int i = 1; i <= 6; ++i) texture.texels.emplace_back(static_cast<float>(i));
    return texture;
}

TEST(Texture, IsItsTexelAtTheCentreOfEach) {
    const Texture texture = numbered();
    for (std::uint32_t row = 0; row < 2; ++row)
        for (std::uint32_t column = 0; column < 3; ++column) {
            const V2f centre((static_cast<float>(column) + 0.5f) / 3, 1 - (static_cast<float>(row) + 0.5f) / 2);
            const float expected = static_cast<float>(3 * row + column + 1);
            EXPECT_NEAR(texel_at(texture, centre).y, expected, 1e-5f);
            EXPECT_NEAR(texel_at(texture, centre + V2f(2, -3)).y, expected, 1e-4f) << "repeated";
        }
}

TEST(Texture, IsLinearBetweenCentresAcrossItsBordersToo) {
    const Texture texture = numbered();
    EXPECT_NEAR(texel_at(texture, {1 / 3.0f, 0.75f}).x, 1.5f, 1e-5f);
    EXPECT_NEAR(texel_at(texture, {1 / 6.0f, 0.5f}).x, 2.5f, 1e-5f);
    EXPECT_NEAR(texel_at(texture, {0, 0.75f}).x, 2, 1e-5f) << "between 3 and 1";
    EXPECT_NEAR(texel_at(texture, {0.5f, 1}).x, 3.5f, 1e-5f) << "between 5 and 2";
}

Scene textured_scene() {
    Scene scene;
    testing_support::add_material(scene, Rgb(0.1f), Rgb(1));
    testing_support::add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    scene.textures = {numbered()};
    scene.materials[0].reflectance_texture = scene.materials[0].exitance_texture = 0;
    scene.texture_coordinates.assign(scene.vertices.size(), V2f(0.5f, 0.5f));
    return scene;
}

TEST(TexturedScene, HasNoFaults) { EXPECT_THAT(scene_faults(textured_scene()), testing::IsEmpty()); }

TEST(Lightmap, HasNoFaultsWhereAllVerticesOfAPatchOrNoneHaveCoordinates) {
    Scene scene = textured_scene();
    scene.lightmap_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
    scene.lightmap_coordinates.assign(4, V2f(not_a_number));
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
}

struct TextureFault {
    const char* name;
    std::function<void(Scene&)> make;
    const char* message;
};
std::ostream& operator<<(std::ostream& out, const TextureFault& fault) { return out << fault.name; }

class TextureFaults : public testing::TestWithParam<TextureFault> {};

TEST_P(TextureFaults, AreFoundAndNamed) {
    Scene scene = textured_scene();
    GetParam().make(scene);
    const std::vector<Fault> faults = scene_faults(scene);
    ASSERT_FALSE(faults.empty());
    EXPECT_THAT(faults[0].text, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, TextureFaults,
    testing::Values(
        TextureFault{"NoSize", [](Scene& s) { s.textures[0].width = 0; }, "texture 'numbers.png' has 0 x 2 texels"},
        TextureFault{"TooWide", [](Scene& s) { s.textures[0].width = max_texels_of_side + 1; },
                     "expected 1 to 16384 a side"},
        TextureFault{"TexelsMissing", [](Scene& s) { s.textures[0].texels.pop_back(); }, "of 3 x 2 texels holds 5"},
        TextureFault{"NegativeTexel", [](Scene& s) { s.textures[0].texels[4].z = -1; },
                     "1 from the left and 1 from the top"},
        TextureFault{"InfiniteTexel",
                     [](Scene& s) { s.textures[0].texels[0].x = std::numeric_limits<float>::infinity(); },
                     "not finite"},
        TextureFault{"NoSuchTexture", [](Scene& s) { s.materials[0].exitance_texture = 1; },
                     "texture 1 does not exist"},
        TextureFault{"ReflectsTooMuch", [](Scene& s) { s.materials[0].reflectance = Rgb(0.2f); },
                     "reflectance times its texture is up to (1.2"},
        TextureFault{"LetsTooMuchThrough",
                     [](Scene& s) {
                         s.materials[0].transmittance = Rgb(0.1f);
                         s.materials[0].transmittance_texture = 0;
                     },
                     "times their textures, are up to (1.2"},
        TextureFault{"NoSuchTransmittance", [](Scene& s) { s.materials[0].transmittance_texture = 7; },
                     "texture 7 does not exist"},
        TextureFault{"EmitsTooMuch", [](Scene& s) { s.materials[0].exitance = Rgb(2e9f); },
                     "times its texture: exitance"},
        TextureFault{"TooDark", [](Scene& s) { s.textures[0].texels.assign(6, Rgb(1e-10f)); },
                     "emits only 1e-10 lm/m2"},
        TextureFault{"NoCoordinates", [](Scene& s) { s.texture_coordinates.clear(); },
                     "patch 0 has a texture, but no texture coordinates"},
        TextureFault{"CoordinatesMissing", [](Scene& s) { s.texture_coordinates.pop_back(); },
                     "4 vertices, but 3 texture coordinates"},
        TextureFault{"CoordinateNotANumber", [](Scene& s) { s.texture_coordinates[2].x = not_a_number; },
                     "vertex 2 has the texture coordinates (nan"},
        TextureFault{"CoordinateTooFar", [](Scene& s) { s.texture_coordinates[1].y = 5000; },
                     "expected numbers up to 4096"},
        TextureFault{"LightmapCoordinatesMissing",
                     [](Scene& s) {
                         s.lightmap_coordinates = {{0, 0}, {1, 0}, {1, 1}};
                     },
                     "4 vertices, but 3 lightmap coordinates"},
        TextureFault{"LightmapCoordinateOutside",
                     [](Scene& s) {
                         s.lightmap_coordinates = {{0, 0}, {1, 0}, {1, 1.001f}, {0, 1}};
                     },
                     "vertex 2 has the lightmap coordinates (1, 1.001)"},
        TextureFault{"HalfALightmapCoordinate",
                     [](Scene& s) {
                         s.lightmap_coordinates = {{0, 0}, {not_a_number, 0}, {1, 1}, {0, 1}};
                     },
                     "vertex 1 has the lightmap coordinates (nan"},
        TextureFault{"LightmapCoordinatesOfSomeVertices",
                     [](Scene& s) {
                         s.lightmap_coordinates = {{0, 0}, {1, 0}, V2f(not_a_number), {0, 1}};
                     },
                     "patch 0 has lightmap coordinates at some of its vertices only"}),
    testing::PrintToStringParamName());

/// Reflectance and transmittance are added texel by texel if the textures have the same size.
TEST(TexturedScene, MayReflectWhereNothingGoesThrough) {
    Scene scene = textured_scene();
    Texture checks{"checks", 3, 2, {Rgb(0), Rgb(1), Rgb(0), Rgb(1), Rgb(0), Rgb(1)}}, others = checks;
    for (Rgb& texel : others.texels) texel = Rgb(1) - texel;
    scene.textures = {checks, others};
    scene.materials[0] = {.name = "screen", .reflectance = Rgb(0.9f), .exitance = Rgb(1), .reflectance_texture = 0};
    scene.materials[0].transmittance = Rgb(1);
    scene.materials[0].transmittance_texture = 1;
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
    scene.materials[0].transmittance_texture = 0;
    EXPECT_THAT(scene_faults(scene), testing::Contains(testing::Field(&Fault::text, HasSubstr("are up to (1.9"))));
    scene.textures[0].width = 6;
    scene.textures[0].height = 1;  // sizes differ: the largest values count
    scene.materials[0].transmittance_texture = 1;
    EXPECT_THAT(scene_faults(scene), testing::Contains(testing::Field(&Fault::text, HasSubstr("are up to (1.9"))));
}

}  // namespace
}  // namespace interflect
