// Surface materials of a glTF file: factors, textures, metals, glass and masks.
//
// Seen to fail when metals reflect, when colours are not decoded from sRGB, when v is not flipped, and when a texture
// transform turns the wrong way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numbers>

#include "interflect/image.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "tests/formats/gltf/builder.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pointwise;
using namespace testing_support;

/// @param pixels  Linear; 8 bit values.
std::string encoded(const std::vector<Rgb>& pixels, int width, const char* extension = ".png") {
    Image image(width, static_cast<int>(pixels.size()) / width);
    image.pixels = pixels;
    const TemporaryFolder folder;
    const auto path = folder.path() / (std::string("image") + extension);
    write_image(path, image);
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Rgb srgb(int r, int g, int b) {
    const auto linear = [](int value) { return srgb_decode(static_cast<float>(value) / 255); };
    return {linear(r), linear(g), linear(b)};
}

json diffuse(const json& more = json::object()) {
    json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
    material["pbrMetallicRoughness"].update(more);
    return material;
}

Material material_of(const json& material, std::vector<std::string>* kinds = nullptr) {
    GltfBuilder file;
    file.add_triangle(material);
    const Scene scene = file.read();
    if (kinds) *kinds = warning_kinds(scene);
    return scene.materials[scene.patches.at(0).material];
}

void expect_close(const Rgb& found, const Rgb& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f) << "channel " << c;
}

TEST(GltfMaterials, BaseColourIsReflectance) {
    std::vector<std::string> kinds;
    const Material material = material_of(diffuse({{"baseColorFactor", {0.5, 0.25, 0.125, 1}}}), &kinds);
    expect_close(material.reflectance, {0.5f, 0.25f, 0.125f});
    EXPECT_EQ(material.exitance, Rgb(0));
    EXPECT_THAT(kinds, Not(Contains("specular-reflection")));
}

TEST(GltfMaterials, WhiteIsReducedTo99Percent) {
    std::vector<std::string> kinds;
    EXPECT_EQ(material_of(diffuse(), &kinds).reflectance, Rgb(0.99f));
    EXPECT_THAT(kinds, Contains("reflectance-clamped"));
}

TEST(GltfMaterials, MetalsLoseTheirReflection) {
    GltfBuilder file;
    file.add_triangle({{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.8, 0.8, 1}}, {"metallicFactor", 0.75}}}});
    const Scene scene = file.read();
    expect_close(scene.materials[0].reflectance, Rgb(0.2f));
    ASSERT_THAT(warning_kinds(scene), Contains("specular-reflection"));
    EXPECT_THAT(scene.warnings.entries()[0].message, HasSubstr("75.0% of all"));
}

struct Layer {
    const char* extension;
    json factors;
    bool reflects;
};
void PrintTo(const Layer& layer, std::ostream* out) { *out << layer.extension << ' ' << layer.factors; }

class GltfLayers : public testing::TestWithParam<Layer> {};

TEST_P(GltfLayers, AreReportedIfTheyReflect) {
    const auto& [extension, factors, reflects] = GetParam();
    json material = diffuse();
    material["extensions"][extension] = factors;
    std::vector<std::string> kinds;
    material_of(material, &kinds);
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "specular-reflection"), reflects ? 1 : 0) << extension << factors;
}

INSTANTIATE_TEST_SUITE_P(
    Of, GltfLayers,
    testing::Values(Layer{"KHR_materials_specular", json::object(), true},
                    Layer{"KHR_materials_specular", {{"specularFactor", 0.5}}, true},
                    Layer{"KHR_materials_specular", {{"specularFactor", 0}}, false},  // Interflect's lightmaps
                    Layer{"KHR_materials_specular", {{"specularColorFactor", {0, 0, 0}}}, false},  // Blender, diffuse
                    Layer{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}, true},
                    Layer{"KHR_materials_clearcoat", json::object(), false},
                    Layer{"KHR_materials_sheen", {{"sheenColorFactor", {0, 0.5, 0}}}, true},
                    Layer{"KHR_materials_sheen", json::object(), false},
                    Layer{"KHR_materials_iridescence", {{"iridescenceFactor", 1}}, true},
                    Layer{"KHR_materials_iridescence", json::object(), false},
                    Layer{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}, true},
                    Layer{"KHR_materials_anisotropy", json::object(), false}),
    printed_name);

/// Colours of vertices were ignored.
TEST(GltfMaterials, AreMultipliedByTheColoursOfVertices) {
    GltfBuilder file;
    file.add_triangle(diffuse({{"baseColorFactor", {0.5, 0.5, 0.8, 1}}}));
    json& attributes = file.file["meshes"][0]["primitives"][0]["attributes"];
    attributes["COLOR_0"] = file.add_vectors({{1, 0.5f, 0}, {1, 0.5f, 0}, {1, 0.5f, 0}});
    const Scene even = file.read();
    expect_close(even.materials[even.patches.at(0).material].reflectance, {0.5f, 0.25f, 0});
    EXPECT_THAT(warning_kinds(even), Not(Contains("vertex-colours")));

    attributes["COLOR_0"] = file.add_vectors({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    const Scene mixed = file.read();
    expect_close(mixed.materials[mixed.patches.at(0).material].reflectance, {0.5f / 3, 0.5f / 3, 0.8f / 3});
    EXPECT_THAT(warning_kinds(mixed), Contains("vertex-colours"));

    attributes["COLOR_0"] = file.add_vectors({{1, 0, 0}, {0, 1, 0}});
    EXPECT_THAT(file.fault(), HasSubstr("2 colours for 3 vertices"));
}

TEST(GltfMaterials, TrianglesOfOtherColoursAreOtherFaces) {
    GltfBuilder file;
    file.add_triangle(diffuse({{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}));
    json& primitive = file.file["meshes"][0]["primitives"][0];
    primitive["attributes"] = {
        {"POSITION", file.add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})},
        {"COLOR_0", file.add_vectors({{.2f, .2f, .2f}, {.2f, .2f, .2f}, {.2f, .2f, .2f}, {.8f, .2f, .2f}})}};
    primitive["indices"] = file.add_indices({0, 1, 2, 0, 1, 3});
    const Scene scene = file.read();
    ASSERT_EQ(scene.patches.size(), 4u);
    std::vector<float> reds;
    for (const Patch& patch : scene.patches) reds.push_back(scene.materials[patch.material].reflectance.x);
    std::sort(reds.begin(), reds.end());
    EXPECT_NEAR(reds.front(), 0.1f, 1e-6f);
    EXPECT_NEAR(reds.back(), 0.2f, 1e-6f);
}

/// The whole file was refused.
TEST(GltfMaterials, MissingImagesLeaveTheFactors) {
    GltfBuilder file;
    file.add("images", {{"uri", "missing.png"}});
    file.add("textures", {{"source", 0}});
    file.add_triangle(diffuse({{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"baseColorTexture", {{"index", 0}}}}));
    const Scene scene = file.read();
    EXPECT_EQ(scene.materials[scene.patches.at(0).material].reflectance, Rgb(0.5f));
    EXPECT_THAT(warning_kinds(scene), Contains("missing-texture"));
    file.file["images"][0]["uri"] = "../missing.png";
    EXPECT_THAT(file.fault(), HasSubstr("outside_files"));
}

TEST(GltfMaterials, RequiredVariantsAreIgnored) {
    GltfBuilder file;
    file.add_triangle();
    file.file["extensionsUsed"] = file.file["extensionsRequired"] = {"KHR_materials_variants"};
    EXPECT_THAT(warning_kinds(file.read()), Contains("extension"));
}

TEST(GltfMaterials, FacesWithoutOneAreGrey) {
    GltfBuilder file;
    file.add_triangle();
    file.file["meshes"][0]["primitives"][0].erase("material");
    const Scene scene = file.read();
    EXPECT_EQ(scene.materials[scene.patches[0].material].reflectance, Rgb(0.5f));
    EXPECT_THAT(warning_kinds(scene), Contains("no-material"));
}

TEST(GltfMaterials, UnlitOnesReflectAndDoNotEmit) {
    json unlit = {{"emissiveFactor", {1, 1, 1}},
                  {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}},
                  {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    std::vector<std::string> kinds;
    const Material material = material_of(unlit, &kinds);
    expect_close(material.reflectance, Rgb(0.5f));
    EXPECT_EQ(material.exitance, Rgb(0));
    EXPECT_THAT(kinds, Contains("unlit"));
}

TEST(GltfMaterials, TransmissionIsThinGlass) {
    json glass = diffuse({{"baseColorFactor", {0.8, 0.4, 0.2, 1}}});
    glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.75;
    const Material material = material_of(glass);
    expect_close(material.reflectance, {0.2f, 0.1f, 0.05f});
    expect_close(material.transmittance, {0.6f, 0.3f, 0.15f});
}

TEST(GltfMaterials, ClearGlassLetsAllThrough) {
    json glass = diffuse();
    glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    expect_close(material_of(glass).transmittance, Rgb(1));
}

TEST(GltfMaterials, BlendedOnesCoverTheShareOfTheirAlpha) {
    json veil = diffuse({{"baseColorFactor", {0.5, 0.5, 0.5, 0.25}}});
    EXPECT_EQ(material_of(veil).transmittance, Rgb(0)) << "opaque, whatever its alpha";
    veil["alphaMode"] = "BLEND";
    expect_close(material_of(veil).reflectance, Rgb(0.125f));
    expect_close(material_of(veil).transmittance, Rgb(0.75f));
}

TEST(GltfMaterials, MasksBelowTheirCutoffLeaveNothing) {
    GltfBuilder file;
    file.add_triangle();
    file.add_triangle(diffuse({{"baseColorFactor", {1, 1, 1, 0.4}}}))["name"] = "masked";
    file.file["materials"][1]["alphaMode"] = "MASK";
    EXPECT_EQ(file.read().patches.size(), 2u);
    file.file["materials"][1]["alphaCutoff"] = 0.3;
    EXPECT_EQ(file.read().patches.size(), 4u);
}

/// A triangle whose base colour has the sRGB code 128 everywhere and alphas of 0, 51, 153 and 255.
class GltfAlpha : public testing::Test {
  protected:
    const float grey = srgb(128, 128, 128).x;
    GltfBuilder file;

    json& material() { return file.file["materials"][0]; }
    void add(const char* mode) {
        Image image(4, 1, Rgb(grey));
        const std::vector<float> alpha = {0, 0.2f, 0.6f, 1};
        const int index = file.add_image(codecs::encode_png(image, alpha));
        file.add_triangle(diffuse({{"baseColorTexture", {{"index", index}}}}));
        material()["alphaMode"] = mode;
    }
    /// Returns the opacity of the triangle's texels, from the transmittance; the reflectance must be that share of
    /// grey.
    std::vector<float> coverage() {
        const Scene scene = file.read();
        const Material& m = scene.materials[scene.patches.at(0).material];
        if (m.transmittance_texture == none) return {};
        std::vector<float> found;
        for (std::size_t i = 0; i < 4; ++i) {
            found.push_back(1 - m.transmittance.x * scene.textures.at(m.transmittance_texture).texels.at(i).x);
            EXPECT_NEAR((m.reflectance * scene.textures.at(m.reflectance_texture).texels.at(i)).x, found[i] * grey,
                        1e-5f);
        }
        return found;
    }
};

/// Seen to fail when alpha is decoded from sRGB, and when reflectances are not scaled.
TEST_F(GltfAlpha, BlendedIsTheShareThatIsThere) {
    add("BLEND");
    EXPECT_THAT(coverage(), Pointwise(FloatNear(1e-5f), {0.0f, 0.2f, 0.6f, 1.0f}));
    material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
    EXPECT_THAT(coverage(), Pointwise(FloatNear(1e-5f), {0.0f, 0.1f, 0.3f, 0.5f}));
}

/// Seen to fail without the factor.
TEST_F(GltfAlpha, MaskedIsThereFromTheCutoffOn) {
    add("MASK");
    EXPECT_THAT(coverage(), ElementsAre(0, 0, 1, 1));
    material()["alphaCutoff"] = 0.2;
    EXPECT_THAT(coverage(), ElementsAre(0, 1, 1, 1));
    material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.25};
    EXPECT_THAT(coverage(), ElementsAre(0, 0, 0, 1));
}

TEST_F(GltfAlpha, OpaqueIsThereWhatever) {
    add("OPAQUE");
    EXPECT_THAT(coverage(), IsEmpty());
}

TEST_F(GltfAlpha, HolesEmitNothing) {
    add("MASK");
    material()["emissiveFactor"] = {1, 0, 0};
    const Scene scene = file.read();
    const Material& m = scene.materials[scene.patches.at(0).material];
    ASSERT_NE(m.exitance_texture, none);
    EXPECT_EQ(scene.textures[m.exitance_texture].texels, (std::vector<Rgb>{Rgb(0), Rgb(0), Rgb(1), Rgb(1)}));
}

TEST_F(GltfAlpha, GlassIsWhereItIsThere) {
    add("BLEND");
    material()["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
    const Scene scene = file.read();
    const Material& m = scene.materials[scene.patches.at(0).material];
    const auto open = scene.textures.at(m.transmittance_texture).texels;
    for (const auto& [i, share] : {std::pair(0, 0.0f), {1, 0.2f}, {2, 0.6f}, {3, 1.0f}})
        EXPECT_NEAR(open[static_cast<std::size_t>(i)].x, 1 - share + share * 0.5f * grey, 1e-5f);
}

Rgb reflectance_at(const Scene& scene, std::size_t texel) {
    const Material& material = scene.materials[scene.patches.at(0).material];
    return material.reflectance * scene.textures.at(material.reflectance_texture).texels.at(texel);
}

/// A triangle with a texture of 2 x 2 pixels; (0, 0) in the file is the upper left one.
class GltfTextures : public testing::Test {
  protected:
    const std::vector<Rgb> pixels = {srgb(10, 20, 30), srgb(40, 50, 60), srgb(70, 80, 90), srgb(100, 110, 120)};
    GltfBuilder file;

    void add_textured(json extra = json::object()) {
        extra["index"] = file.add_image(encoded(pixels, 2));
        file.add_triangle(diffuse({{"baseColorTexture", extra}}));
    }
};

TEST_F(GltfTextures, AreDecodedFromSrgbWithTheUpperRowFirst) {
    add_textured();
    const Scene scene = file.read();
    ASSERT_EQ(scene.textures.size(), 1u);
    for (std::size_t i = 0; i < 4; ++i) expect_close(reflectance_at(scene, i), pixels[i]);
    std::vector<V2f> found;
    for (std::size_t k = 0; k < 3; ++k) found.push_back(scene.texture_coordinates[scene.patches[0].vertices[k]]);
    EXPECT_THAT(found, ElementsAre(V2f(0, 1), V2f(1, 1), V2f(0, 0))) << "v goes up in a Scene";
}

TEST_F(GltfTextures, SharedByMaterialsAreOne) {
    add_textured();
    json& basis = file.file["materials"][0]["pbrMetallicRoughness"];
    basis["baseColorFactor"] = {0.8, 0.8, 0.8, 1};
    json other = file.file["materials"][0];
    other["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
    file.add_triangle(other);
    const Scene scene = file.read();
    EXPECT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.materials.at(1).reflectance, Rgb(0.5f));
}

TEST_F(GltfTextures, JpegIsReadToo) {
    const std::vector<Rgb> grey(64, srgb(128, 128, 128));
    file.add_triangle(diffuse({{"baseColorTexture", {{"index", file.add_image(encoded(grey, 8, ".jpg"))}}}}));
    const Scene scene = file.read();
    for (std::size_t i = 0; i < grey.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(reflectance_at(scene, i)[c], grey[0][c], 0.01f);
}

/// The specification's own example: the image's lower left quadrant, rotated.
TEST_F(GltfTextures, TransformScalesTurnsAndMoves) {
    add_textured({{"extensions",
                   {{"KHR_texture_transform",
                     {{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}}}}}});
    const Scene scene = file.read();
    std::vector<V2f> found;
    for (std::size_t k = 0; k < 3; ++k) found.push_back(scene.texture_coordinates[scene.patches[0].vertices[k]]);
    const std::vector<V2f> expected = {{0, 0}, {0, 0.5f}, {0.5f, 0}};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((found[k] - expected[k]).length(), 1e-6f) << k << ": " << found[k];
}

TEST_F(GltfTextures, OfMetalReduceTheReflectance) {
    add_textured();
    const std::string metallic = encoded({Rgb(0), Rgb(0, 0, 1), Rgb(0), Rgb(1, 1, 0)}, 2);
    json& rough = file.file["materials"][0]["pbrMetallicRoughness"];
    rough["metallicFactor"] = 0.5;
    rough["metallicRoughnessTexture"]["index"] = file.add_image(metallic);
    const Scene scene = file.read();
    expect_close(reflectance_at(scene, 1), pixels[1] * 0.5f);
    expect_close(reflectance_at(scene, 3), pixels[3]);
}

TEST_F(GltfTextures, OfEmissionMultiplyTheExitance) {
    json glow = diffuse();
    glow["emissiveFactor"] = {1, 1, 1};
    glow["emissiveTexture"]["index"] = file.add_image(encoded(pixels, 2));
    file.add_triangle(glow);
    const Scene scene = file.read();
    const Material& material = scene.materials[scene.patches[0].material];
    expect_close(material.exitance, Rgb(std::numbers::pi_v<float>));
    ASSERT_EQ(material.exitance_texture, 0u);
    expect_close(scene.textures[0].texels[2], pixels[2]);
}

TEST_F(GltfTextures, WithoutCoordinatesAreReplacedByTheirMean) {
    add_textured();
    file.file["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    const Scene scene = file.read();
    const Material& material = scene.materials[scene.patches[0].material];
    EXPECT_FALSE(material.is_textured());
    expect_close(material.reflectance, Rgb(pixels[0] + pixels[1] + pixels[2] + pixels[3]) * 0.25f);
    EXPECT_THAT(warning_kinds(scene), Contains("texture-coordinates"));
}

TEST_F(GltfTextures, OfOtherCoordinatesThanTheEmissionAreReplacedByTheirMean) {
    add_textured();
    json& material = file.file["materials"][0];
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    file.file["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        file.add_coordinates({{0, 0.5f}, {0, 0}, {1, 1}});
    const Scene scene = file.read();
    const Material& found = scene.materials[scene.patches[0].material];
    EXPECT_EQ(found.reflectance_texture, none);
    EXPECT_EQ(found.exitance_texture, 0u);
    EXPECT_EQ(scene.texture_coordinates[scene.patches[0].vertices[0]], V2f(0, 0.5f));
    EXPECT_THAT(warning_kinds(scene), Contains("texture-coordinates"));
}

TEST_F(GltfTextures, MayUseTheCoordinatesOfTheLightmap) {
    add_textured({{"texCoord", 1}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}});
    file.file["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        file.add_coordinates({{0, 0.5f}, {0, 0}, {1, 1}});
    const Scene scene = file.read();
    const std::uint32_t vertex = scene.patches[0].vertices[0];
    EXPECT_EQ(scene.texture_coordinates.at(vertex), V2f(0.5f, 0.5f));
    EXPECT_EQ(scene.lightmap_coordinates.at(vertex), V2f(0, 0.5f)) << "the transform is the texture's";
}

TEST_F(GltfTextures, ThatReflectAllAreReducedTo99Percent) {
    file.add_triangle(diffuse({{"baseColorTexture", {{"index", file.add_image(encoded({Rgb(1), Rgb(0.5f)}, 2))}}}}));
    const Scene scene = file.read();
    EXPECT_NEAR(reflectance_at(scene, 0).x, 0.99f, 1e-5f);
    EXPECT_NEAR(reflectance_at(scene, 1).x, 0.5f, 0.01f) << "only what is too much is reduced";
    EXPECT_THAT(warning_kinds(scene), Contains("reflectance-clamped"));
}

TEST_F(GltfTextures, OfKtx2AreReplacedByTheirFallbackOrRefused) {
    add_textured();
    file.file["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
    EXPECT_THAT(warning_kinds(file.read()), Contains("texture-format"));
    file.file["textures"][0].erase("source");
    EXPECT_THAT(file.fault(), HasSubstr("KHR_texture_basisu, which is not read"));
}

TEST_F(GltfTextures, ClampedBeyondTheirEdgesAreWarnedOf) {
    add_textured();
    file.file["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33071}}};
    file.file["textures"][0]["sampler"] = 0;
    EXPECT_THAT(warning_kinds(file.read()), IsEmpty()) << "within the image";
    file.file["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        file.add_coordinates({{0, 0}, {2, 0}, {0, 1}});
    EXPECT_THAT(warning_kinds(file.read()), ElementsAre("texture-wrap"));
}

}  // namespace
}  // namespace interflect
