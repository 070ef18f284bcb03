// Updates of some objects in an existing lightmap (LightmapOptions::update). tests/python/lit_files_test.py has those
// in the glTF file of the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "interflect/base/files/input_file.h"
#include "interflect/export.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace lightmap_testing;
using testing::HasSubstr;

class LightmapUpdate : public testing::Test {
  protected:
    const std::filesystem::path folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("update-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    Scene scene_;
    ExportOptions options_ = at(10);

    /// A wall of 2 x 1 m, and a lamp of 1 x 1 m that faces it.
    LightmapUpdate() {
        std::filesystem::create_directories(folder_);
        const std::uint32_t material = testing_support::add_material(scene_, Rgb(0.5f), Rgb(0));
        scene_.objects = {"", "room.wall", "lamp"};
        const PatchIndex wall = testing_support::add_rectangle(scene_, V3f(0), V3f(2, 0, 0), V3f(0, 1, 0), material);
        const PatchIndex lamp =
            testing_support::add_rectangle(scene_, V3f(1, 0, 1), V3f(0, 1, 0), V3f(1, 0, 0), material);
        scene_.patches[wall].object = 1;
        scene_.patches[lamp].object = 2;
    }
    ~LightmapUpdate() override { std::filesystem::remove_all(folder_); }

    void write(const Solution& solution) { export_solution(folder_ / "lit.glb", scene_, solution, options_); }
    Image light(const char* name = "lit.lightmap-0.exr") const { return read_image(folder_ / name); }
    std::string refusal(const Solution& solution) {
        try {
            write(solution);
        } catch (const InputError& refused) {
            return refused.what();
        }
        return "";
    }
};

/// Returns the number of texels of each value.
std::map<float, int> counts(const Image& image) {
    std::map<float, int> result;
    for (const Rgb& texel : image.pixels) ++result[texel.y];
    return result;
}

/// Seen to fail if all charts are computed.
TEST_F(LightmapUpdate, ChangesTheTexelsOfItsObjectsAlone) {
    write(uniform(scene_, 100));
    const Image before = light();
    options_.lightmap->update = {"la*"};
    write(uniform(scene_, 300));
    const Image after = light();
    ASSERT_EQ(after.pixels.size(), before.pixels.size());
    constexpr int lamp_texels = (11 + 4) * (11 + 4), wall_texels = (21 + 4) * (11 + 4);  // with gutters of 2
    const std::map<float, int> values = counts(after);
    EXPECT_EQ(values.at(300), lamp_texels);
    EXPECT_EQ(values.at(100), wall_texels);
    options_.lightmap->update = {"room"};  // an enclosing object
    write(uniform(scene_, 300));
    EXPECT_EQ(counts(light()).at(300), lamp_texels + wall_texels);
}

/// The images of each group and their sum keep the other texels. Seen to fail if the groups start black.
TEST_F(LightmapUpdate, KeepsTheTexelsOfLightGroups) {
    const auto of_groups = [&](float a, float b) {
        Solution solution = uniform(scene_, a + b);
        solution.group_names = {"a", "b"};
        for (const float light : {a, b}) solution.groups.push_back(uniform(scene_, light).irradiance);
        return solution;
    };
    scene_.light_groups = {{"a", "left"}, {"b", "right"}};
    options_.lightmap->groups = true;
    write(of_groups(1, 2));
    options_.lightmap->update = {"lamp"};
    write(of_groups(10, 20));
    EXPECT_EQ(counts(light("lit.lightmap-0-group-1.exr")).count(2), 1);
    const std::map<float, int> values = counts(light());
    EXPECT_EQ(values.count(3), 1);
    EXPECT_EQ(values.count(30), 1);
}

/// Seen to fail without the comparison of names, options and quantity, and with a checksum without outlines.
TEST_F(LightmapUpdate, OfAnotherLayoutNamesTheDifference) {
    options_.lightmap->update = {"lamp"};
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("not there"));
    options_.lightmap->update.clear();
    write(uniform(scene_, 1));

    options_.lightmap->update = {"lamp", "chair"};
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("'chair'"));
    options_.lightmap->update = {"lamp"};
    options_.lightmap->gutter = 3;
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("gutter is 2, not 3"));
    options_.lightmap->gutter = 2;
    options_.lightmap->content = LightmapContent::radiance;
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("quantity is \"irradiance\", not \"radiance\""));
    options_.lightmap->content = LightmapContent::irradiance;
    for (V3f& x : scene_.vertices) x *= 2;
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("other places"));
    for (V3f& x : scene_.vertices) x /= 2;
    V3f& corner = scene_.vertices[scene_.patches[PatchIndex(1)].vertices[2]];
    const V3f old_corner = std::exchange(corner, {1.9f, 0.9f, 1});  // in the same rectangle
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("shapes"));
    corner = old_corner;
    std::filesystem::remove(folder_ / "lit.lightmap-0.exr");
    EXPECT_THAT(refusal(uniform(scene_, 1)), HasSubstr("lit.lightmap-0.exr"));
}

/// A layout of the scene's file is one chart, also with several materials.
TEST_F(LightmapUpdate, ComputesWholeCharts) {
    const std::uint32_t stripe = testing_support::add_material(scene_, Rgb(0.5f), Rgb(0));
    scene_.materials[stripe].name = "stripe";
    const PatchIndex patch = testing_support::add_rectangle(scene_, V3f(0, 1, 0), V3f(2, 0, 0), V3f(0, 1, 0), stripe);
    scene_.patches[patch].object = 1;
    for (const V3f& x : scene_.vertices)  // the lamp, at z = 1, has no layout
        scene_.lightmap_coordinates.push_back(x.z > 0 ? V2f(std::nanf("")) : V2f(x.x, x.y) / 4);
    write(uniform(scene_, 100));
    options_.lightmap->update = {"stripe"};
    write(uniform(scene_, 300));
    EXPECT_EQ(counts(light()).at(300), (21 + 4) * (21 + 4));
}

/// Numbers that would make the images invalid, and a name in another folder. Seen to fail without these checks.
TEST_F(LightmapUpdate, RefusesDamagedFiles) {
    write(uniform(scene_, 1));
    const std::string bytes = read_bytes(folder_ / "lit.glb");
    options_.lightmap->update = {"lamp"};
    const auto refusal_with = [&](const std::string& found, std::string replacement) {
        std::string damaged = bytes;
        const std::size_t at = damaged.find(found);
        replacement.resize(found.size(), ' ');
        if (at != std::string::npos) damaged.replace(at, found.size(), replacement);
        std::ofstream(folder_ / "lit.glb", std::ios::binary) << damaged;
        return refusal(uniform(scene_, 1));
    };
    EXPECT_THAT(refusal_with("\"scale\":1.0", "\"scale\":0"), HasSubstr("the scale is 0"));
    EXPECT_THAT(refusal_with("\"stops\":0.0", "\"stops\":-1"), HasSubstr("the range in stops is -1"));
    EXPECT_THAT(refusal_with("\"interflect\"", "\"other\""), HasSubstr("a lightmap of this version"));
    EXPECT_THAT(refusal_with("\"lit.lightmap-0.exr\"]", "\"/../../tmp/a.exr\"]"),
                HasSubstr((folder_ / "a.exr").string()));
}

}  // namespace
}  // namespace interflect
