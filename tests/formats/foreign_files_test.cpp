// Files that other files name: permitted locations, and messages that do not quote them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "interflect/core.h"
#include "interflect/formats/photometry/ies.h"
#include "interflect/formats/text/foreign_text.h"
#include "interflect/load.h"
#include "tests/formats/gltf/builder.h"
#include "tests/support/refusals.h"
#include "tests/support/scenes/photometry_files.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing_support::GltfBuilder;
using testing_support::IesText;
using testing_support::message_of;
using testing_support::TemporaryFolder;

TEST(WithoutQuotes, RemovesFromTheFirstMarkToTheLast) {
    EXPECT_EQ(without_quotes("expected 'a', found 'b'!"), "expected ...!");
    EXPECT_EQ(without_quotes("found 'root'x'"), "found ...");
    EXPECT_EQ(without_quotes("found 'cut off"), "found ...");
    EXPECT_EQ(without_quotes("nothing is quoted"), "nothing is quoted");
    EXPECT_EQ(without_quotes("it's.ies: found 'a'", 8), "it's.ies: found ...");
    EXPECT_EQ(without_quotes("expected the lamp's geometry, found 'a'"), "expected the lamp's geometry, found ...");
    EXPECT_EQ(without_quotes("the lamp's geometry is missing"), "the lamp's geometry is missing");
}

class TiltFiles : public testing::Test {
  protected:
    TiltFiles() {
        fs::create_directory(folder.path() / "lamps");
        folder.write("outside.tlt", "1 1\n0\n0.5\n");
        folder.write("secret", "secret:x:0:0\n");
        folder.write("lamps/secret", "secret:x:0:0\n");
        folder.write("lamps/4711", "4711\n");
        fs::create_symlink(folder.path() / "outside.tlt", folder.path() / "lamps/link.tlt");
    }

    /// Returns the error for a file beside `lamps/secret` with this TILT file; "no error" if it can be read.
    std::string fault(const std::string& tilt, const ReadOptions& options = {}) {
        const fs::path path = folder.write("lamps/lamp.ies", IesText{.tilt = "TILT=" + tilt + "\n"}.str());
        Warnings warnings;
        return message_of([&] { load_photometric_web(path, options, warnings); });
    }

    TemporaryFolder folder;
};

TEST_F(TiltFiles, OutsideTheFolderAreRefusedUnlessAllowed) {
    for (const std::string& tilt :
         {std::string("../outside.tlt"), std::string("link.tlt"), (folder.path() / "outside.tlt").string()}) {
        EXPECT_THAT(fault(tilt), HasSubstr("lamp.ies:3: the TILT file")) << tilt;
        EXPECT_THAT(fault(tilt), HasSubstr("outside_files")) << tilt;
        EXPECT_EQ(fault(tilt, {.outside_files = true}), "no error") << tilt;
    }
    EXPECT_THAT(fault("secret", {.max_include_depth = 0}), HasSubstr("max_include_depth"));
}

TEST_F(TiltFiles, AreNotQuoted) {
    EXPECT_THAT(fault("../secret", {.outside_files = true}), HasSubstr("has no TILT data"));
    EXPECT_THAT(fault("../secret", {.outside_files = true}), Not(HasSubstr("secret:x")));
    EXPECT_THAT(fault("secret"), Not(HasSubstr("secret:x")));
    EXPECT_THAT(fault("4711"), Not(HasSubstr("is 4711")));
}

TEST_F(TiltFiles, OfFilesWithinAGltfLieInItsFolder) {
    // The name of the profile is not part of the path.
    GltfBuilder file;
    file.add_triangle();
    file.add_node({{"extensions", {{"EXT_lights_ies", {{"light", 0}}}}}});
    const auto fault_of = [&](const std::string& tilt) {
        const std::string ies = IesText{.tilt = "TILT=" + tilt + "\n"}.str();
        file.file["extensions"]["EXT_lights_ies"]["lights"] = {
            {{"bufferView", file.add_view(ies)}, {"name", "../../../x"}}};
        const fs::path path = folder.write("lamps/scene.glb", file.glb());
        return message_of([&] { load_scene(path); });
    };
    EXPECT_THAT(fault_of("../secret"), HasSubstr("outside_files"));
    EXPECT_THAT(fault_of("/etc/passwd"), HasSubstr("outside_files"));
    EXPECT_THAT(fault_of("secret"), HasSubstr("has no TILT data"));
}

struct NamingScene {
    const char *name, *scene, *text, *file;
};
void PrintTo(const NamingScene& scene, std::ostream* out) { *out << scene.name; }

class NamedFiles : public testing::TestWithParam<NamingScene> {};
TEST_P(NamedFiles, AreNotQuoted) {
    for (const char* content :
         {"Secret:x:0:0\n", "IESSecret\n", "IESNA91\nTILT=NONE\nSecret\n", "f Secret x y\n",
          "m Secret'Secret =\n rd Secret\n", "xf Secret\n", "newmtl a\nKd Secret\n", "newmtl a\nd 1 Secret\n",
          "void plastic Secret 0 0 5 a\n", "void Secret Secret 0 0 0\n", "!Secret\n", "Secret Secret Secret 0 0 0\n"}) {
        const TemporaryFolder folder;
        folder.write(GetParam().file, content);
        const fs::path path = folder.write(GetParam().scene, GetParam().text);
        const std::string message = message_of([&] {
            const Scene scene = load_scene(path);
            for (const Warnings::Entry& warning : scene.warnings.entries())
                EXPECT_THAT(warning.message, Not(HasSubstr("Secret"))) << content;
        });
        EXPECT_THAT(message, Not(HasSubstr("Secret"))) << content;
    }
}

constexpr const char* mgf_face = "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nf a b c\n";
const std::string mgf_with_part = std::string(mgf_face) + "i other\n";
const std::string mgf_with_lamp = std::string(mgf_face) + "ies other.ies\n";
constexpr const char* gltf_with_lamp = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
    "nodes": [{"extensions": {"EXT_lights_ies": {"light": 0}}}],
    "extensions": {"EXT_lights_ies": {"lights": [{"uri": "other.ies"}]}}})";
INSTANTIATE_TEST_SUITE_P(All, NamedFiles,
                         testing::Values(NamingScene{"MgfInclude", "scene.mgf", mgf_with_part.c_str(), "other"},
                                         NamingScene{"MgfLuminaire", "scene.mgf", mgf_with_lamp.c_str(), "other.ies"},
                                         NamingScene{"ObjMaterials", "scene.obj",
                                                     "mtllib other\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n",
                                                     "other"},
                                         NamingScene{"RadInclude", "scene.rad", "!xform other\n", "other"},
                                         NamingScene{"GltfLuminaire", "scene.gltf", gltf_with_lamp, "other.ies"}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace interflect
