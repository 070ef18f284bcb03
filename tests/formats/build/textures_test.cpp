// Interflect's own entities of MGF, `uv` and `texture`: docs/files/mgf-extensions.md.
//
// Seen to fail when images are not found relative to the file that names them, when a material's textures are not part
// of its identity, and when texels beyond 8 bits are written as PNG.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "interflect/core.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/mgf/write_mgf.h"
#include "interflect/generate.h"
#include "interflect/image.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/load.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

const std::string three_vertices =
    "v a =\n p 0 0 0\n uv 0 0\nv b =\n p 1 0 0\n uv 1 0\nv d =\n p 1 1 0\n uv 1 1\n";  // nine lines

class MgfTextures : public testing::Test {
  protected:
    /// Two by two texels: dark, dark; dark, bright.
    MgfTextures() { write_image_of(0.5f, "image.exr"); }

    void write_image_of(float brightest, const char* name) {
        Image image(2, 2, Rgb(0.25f));
        image.at(1, 1) = Rgb(brightest, 0.25f, 0);
        write_image(folder.path() / name, image);
    }
    Scene read(const std::string& text) { return read_mgf(folder.write("scene.mgf", text)); }
    std::string fault(const std::string& text) {
        try {
            read(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
    TemporaryFolder folder;
};

TEST_F(MgfTextures, BelongToMaterialsAndCoordinatesToVertices) {
    const Scene scene = read(three_vertices +
                             "m paint =\n rd .8\n texture rd image.exr\nf a b d\n"
                             "m lamp = paint\n ed 10\n texture ed image.exr\nf a b d\nm plain =\n rd .5\nf a b d\n");
    ASSERT_EQ(scene.textures.size(), 1u) << "one file is one texture";
    EXPECT_EQ(scene.textures[0].texels[3], Rgb(0.5f, 0.25f, 0));
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].reflectance_texture, 0u);
    EXPECT_EQ(scene.materials[0].exitance_texture, none);
    EXPECT_EQ(scene.materials[1].reflectance_texture, 0u) << "from its template";
    EXPECT_EQ(scene.materials[1].exitance_texture, 0u);
    EXPECT_FALSE(scene.materials[2].is_textured());
    EXPECT_EQ(scene.texture_coordinates, (std::vector<V2f>{{0, 0}, {1, 0}, {1, 1}}));
    EXPECT_EQ(scene.files.size(), 2u);
    EXPECT_TRUE(scene.warnings.entries().empty());
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
}

/// Seen to fail when `rd` alone is limited to 0.99, which darkens all colours by 1%.
TEST_F(MgfTextures, HaveTheirColoursIfTheReflectanceIsOne) {
    const auto scene_of = [&](const char* image) {
        return read(three_vertices + "m paint =\n rd 1\n texture rd " + image + "\nf a b d\n");
    };
    const auto warnings = [](const Scene& scene) { return scene.warnings.entries().size(); };
    const Scene grey = scene_of("image.exr");
    EXPECT_NEAR(grey.materials[0].reflectance.x, 1, 1e-6);
    EXPECT_EQ(warnings(grey), 0u);
    write_image_of(1, "white.exr");
    const Scene white = scene_of("white.exr");
    EXPECT_NEAR(white.materials[0].reflectance.x, 0.99, 1e-6);  // times a red texel of 1
    EXPECT_NEAR(white.materials[0].reflectance.y, 1, 1e-6);
    EXPECT_EQ(warnings(white), 1u);
    EXPECT_THAT(scene_faults(white), testing::IsEmpty());
}

/// Seen to fail when materials that differ only in this are merged.
TEST_F(MgfTextures, OfTransmittanceMakeHoles) {
    const std::string material = "m fence =\n rd .5\n ts 1 0\n texture rd black.exr\n";
    Image image(2, 1, Rgb(1));
    image.at(0, 0) = Rgb(0);
    write_image(folder.path() / "black.exr", image);
    image = Image(2, 1, Rgb(0));
    image.at(0, 0) = Rgb(1);
    write_image(folder.path() / "holes.exr", image);
    const Scene scene = read(three_vertices + material + " texture ts holes.exr\nf a b d\n");
    const Material& fence = scene.materials.at(scene.patches.at(0).material);
    EXPECT_EQ(fence.transmittance, Rgb(1));
    ASSERT_NE(fence.transmittance_texture, none);
    EXPECT_EQ(scene.textures[fence.transmittance_texture].texels[0], Rgb(1));
    EXPECT_THAT(scene_faults(scene), testing::IsEmpty());
    EXPECT_TRUE(scene.warnings.entries().empty());
    EXPECT_THAT(fault(three_vertices + material + " texture ts black.exr\nf a b d\n"),
                HasSubstr("rd, rs and ts times their textures are up to (1.5"));
    fs::copy_file(folder.path() / "holes.exr", folder.path() / "other.exr");
    const Scene others = read(three_vertices + material + " texture ts holes.exr\nf a b d\n" + material +
                              " texture ts other.exr\nf a b d\n");
    EXPECT_EQ(others.materials.size(), 2u);
}

TEST_F(MgfTextures, MaterialsThatDifferInTheirTextureAlone) {
    write_image_of(0.75f, "other.exr");
    const Scene scene = read(three_vertices +
                             "m paint =\n rd .8\n texture rd image.exr\nf a b d\n"
                             "m paint =\n rd .8\n texture rd other.exr\nf a b d\nm paint =\n rd .8\nf a b d\n");
    EXPECT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.textures.size(), 2u);
}

TEST_F(MgfTextures, OnePositionWithTwoCoordinatesIsTwoVertices) {
    const Scene scene = read(three_vertices + "v e =\n p 1 1 0\n uv 2 2\nm paint =\n rd .5\nf a b d\nf a b e\n");
    EXPECT_EQ(scene.vertices.size(), 4u);
    EXPECT_EQ(scene.vertices[2], scene.vertices[3]);
    EXPECT_EQ(scene.texture_coordinates[3], V2f(2, 2));
}

TEST_F(MgfTextures, OfAnIncludedFileAreBesideThat) {
    fs::create_directory(folder.path() / "parts");
    fs::rename(folder.path() / "image.exr", folder.path() / "parts/image.exr");
    folder.write("parts/part.mgf", three_vertices + "m paint =\n rd .8\n texture rd image.exr\nf a b d\n");
    EXPECT_EQ(read("i parts/part.mgf\n").textures.size(), 1u);
}

TEST_F(MgfTextures, MayBePhotographs) {
    write_image(folder.path() / "photo.jpg", Image(16, 16, Rgb(0.25f, 0.5f, 0.1f)));
    const Scene scene = read(three_vertices + "m paint =\n rd .8\n texture rd photo.jpg\nf a b d\n");
    ASSERT_EQ(scene.textures.at(0).texels.size(), 256u);
    for (const Rgb& texel : scene.textures[0].texels)
        EXPECT_LT((texel - Rgb(0.25f, 0.5f, 0.1f)).length(), 0.02f);  // loss due to JPEG
}

TEST_F(MgfTextures, OfAMaterialThatNoFaceUsesAreNotRead) {
    const Scene scene = read(three_vertices + "m bad =\n texture rd nowhere.png\nm good =\n rd .5\nf a b d\n");
    EXPECT_TRUE(scene.textures.empty());
}

TEST_F(MgfTextures, FarFromTheOriginAreReadAsWell) {
    const Scene scene =
        read("m paint =\n rd .8\n texture rd image.exr\nxf -t 1e6 0 0\n" + three_vertices + "f a b d\nxf\n");
    EXPECT_NE(scene.origin, Imath::V3d(0));
    EXPECT_EQ(scene.texture_coordinates, (std::vector<V2f>{{0, 0}, {1, 0}, {1, 1}}));
}

struct BadTexture {
    const char* name;
    const char* lines;     // from the tenth on; then a face uses them
    const char* expected;  // part of the message
};
void PrintTo(const BadTexture& bad, std::ostream* out) { *out << bad.name; }

class MgfBadTexture : public MgfTextures, public testing::WithParamInterface<BadTexture> {};

TEST_P(MgfBadTexture, IsNamedWithItsFault) {
    write_image_of(3, "bright.exr");
    write_image_of(-1, "negative.exr");
    folder.write("empty.png", "");
    folder.write("text.png", "no image");
    folder.write("photo.jpg", "");
    const std::string error = fault(three_vertices + GetParam().lines + "\nf a b d\n");
    EXPECT_THAT(error, HasSubstr("scene.mgf:10: "));
    EXPECT_THAT(error, HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    All, MgfBadTexture,
    testing::Values(
        BadTexture{"NoFile", "texture rd", "expected 'texture rd|ed|ts image'"},
        BadTexture{"OfWhat", "texture rs image.exr", "a texture is one of rd, ts or ed, not of 'rs'"},
        BadTexture{"MissingImage", "texture rd nowhere.png\nrd .5", "no such file"},
        BadTexture{"Folder", "texture rd .\nrd .5", "this is a folder"},
        BadTexture{"UnknownFormat", "texture rd scene.mgf\nrd .5", "no image format has the extension '.mgf'"},
        BadTexture{"EmptyImage", "texture rd empty.png\nrd .5", "cannot read this image"},
        BadTexture{"NoImage", "texture rd text.png\nrd .5", "cannot read this image"},
        BadTexture{"EmptyJpeg", "texture rd photo.jpg\nrd .5", "cannot read this image"},
        BadTexture{"NegativeTexel", "texture rd negative.exr\nrd .5", "1 from the left and 1 from the top"},
        BadTexture{"ReflectsTooMuch", "texture rd bright.exr\nrd .5", "reflectance times texture is up to (1.5"},
        BadTexture{"EmitsTooMuch", "texture ed bright.exr\ned 9e9", "cannot be computed: expected at most 1e+10"},
        BadTexture{"CoordinateNotANumber", "uv 0 x", "'x' is not a finite number"},
        BadTexture{"CoordinateTooFar", "uv 0 5000", "expected numbers up to 4096"},
        BadTexture{"OneCoordinate", "uv 0", "expected 'uv u v'"}),
    testing::PrintToStringParamName());

TEST_F(MgfTextures, NeedCoordinates) {
    EXPECT_THAT(fault(three_vertices + "m paint =\n texture rd image.exr\nv e =\n p 0 1 0\nf a b e\n"),
                HasSubstr("scene.mgf:14: vertex 'e' needs texture coordinates (uv)"));
    EXPECT_THAT(fault(three_vertices + "m paint =\n texture rd image.exr\nsph a 1\n"),
                HasSubstr("only faces (f, fh) have texture"));
}

Scene there_and_back(const Scene& scene, const fs::path& path) {
    const std::vector<std::string> names = texture_files(scene, path);
    write_mgf(scene, path, names);
    for (std::size_t i = 0; i < names.size(); ++i) write_texture(path.parent_path() / names[i], scene.textures[i]);
    return load_scene(path);
}

/// Expects equal scenes, except for textures' names; every textured patch has its own vertices in `expected`.
void expect_same(const Scene& actual, const Scene& expected) {
    ASSERT_EQ(actual.patches.size(), expected.patches.size());
    ASSERT_FALSE(expected.textures.empty());
    for (std::size_t i = 0; i < expected.patches.size(); ++i) {
        const Patch &a = actual.patches[i], &b = expected.patches[i];
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(actual.vertices[a.vertices[k]], expected.vertices[b.vertices[k]]) << "patch " << i;
            ASSERT_EQ(actual.texture_coordinates[a.vertices[k]], expected.texture_coordinates[b.vertices[k]]) << i;
        }
        const Material &m = actual.materials[a.material], &n = expected.materials[b.material];
        const auto texels = [](const Scene& scene, std::uint32_t texture) {
            return texture == none ? std::vector<Rgb>() : scene.textures[texture].texels;
        };
        ASSERT_EQ(texels(actual, m.reflectance_texture), texels(expected, n.reflectance_texture)) << "patch " << i;
        ASSERT_EQ(texels(actual, m.exitance_texture), texels(expected, n.exitance_texture)) << "patch " << i;
        ASSERT_EQ(texels(actual, m.transmittance_texture), texels(expected, n.transmittance_texture)) << "patch " << i;
    }
    EXPECT_TRUE(actual.warnings.entries().empty());
}

TEST_F(MgfTextures, OfAMadeSceneComeBack) {
    const Scene made = make_boxes({.boxes = 3, .seed = 2, .texture = true});
    expect_same(there_and_back(made, folder.path() / "my boxes.mgf"), made);
    EXPECT_TRUE(fs::exists(folder.path() / "my_boxes.texture-0.png"));
}

TEST_F(MgfTextures, ThatNoPngCanHoldComeBackFromExr) {
    Scene made = make_boxes({.boxes = 3, .seed = 2, .texture = true});
    made.textures[0].texels[5] = Rgb(0.123456f, 1e-7f, 1.001f);
    made.textures[2].texels[7] = Rgb(50, 0, 0);
    expect_same(there_and_back(made, folder.path() / "boxes.mgf"), made);
    EXPECT_TRUE(fs::exists(folder.path() / "boxes.texture-0.exr"));
    EXPECT_TRUE(fs::exists(folder.path() / "boxes.texture-1.png"));
}

TEST(MgfWriter, RefusesTexturesWithoutFiles) {
    std::ostringstream out;
    EXPECT_THROW(write_mgf(make_boxes({.boxes = 1, .texture = true}), out), std::runtime_error);
}

TEST(TextureFiles, EveryEightBitValueComesBackFromPng) {
    TemporaryFolder folder;
    Texture texture{"grey", 256, 1, {}};
    for (int i = 0; i < 256; ++i) texture.texels.emplace_back(srgb_decode(static_cast<float>(i) / 255));
    ASSERT_EQ(texture_extension(texture), ".png");
    write_texture(folder.path() / "grey.png", texture);
    EXPECT_EQ(read_texture(folder.path() / "grey.png").texels, texture.texels);
}

}  // namespace
}  // namespace interflect
