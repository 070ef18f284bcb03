#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "interflect/scene.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Two two-sided faces, one material, one view, without faults.
Scene valid_scene() {
    Scene scene;
    testing_support::add_material(scene, Rgb(0.5f), Rgb(1));
    testing_support::add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 2, 1, true);
    scene.views = {View()};
    return scene;
}

void scale(Scene& scene, float factor) {
    for (V3f& x : scene.vertices) x *= factor;
}

struct FaultCase {
    const char* name;
    std::function<void(Scene&)> make;
    const char* message;
};

std::ostream& operator<<(std::ostream& out, const FaultCase& fault) { return out << fault.name; }

class SceneFaults : public testing::TestWithParam<FaultCase> {};

/// The faults of the origin were seen to fail when it is not checked.
TEST_P(SceneFaults, AreFoundAndNamed) {
    Scene scene = valid_scene();
    GetParam().make(scene);
    const std::vector<Fault> faults = scene_faults(scene);
    ASSERT_FALSE(faults.empty());
    EXPECT_THAT(faults[0].text, HasSubstr(GetParam().message));
}

TEST_P(SceneFaults, AreRefusedByWhatDividesFaces) {
    Scene scene = valid_scene();
    GetParam().make(scene);
    EXPECT_THROW(split_patches(scene, 0.5f, 1'000), InputError);
    EXPECT_THROW(cut_at_contacts(scene), InputError);
}

TEST(SplitPatches, RefusesEdgesThatCannotBe) {
    for (const float edge : {0.0f, -1.0f, std::nanf("")})
        EXPECT_THROW(split_patches(valid_scene(), edge, 1'000), InputError) << edge;
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneFaults,
    testing::Values(
        FaultCase{"nan_vertex", [](Scene& s) { s.vertices[1].y = std::nanf(""); }, "vertex 1 is not finite"},
        FaultCase{"infinite_vertex", [](Scene& s) { s.vertices[0].x = infinity; }, "vertex 0 is not finite"},
        FaultCase{"reflectance_of_one", [](Scene& s) { s.materials[0].reflectance.y = 1; },
                  "reflectance (0.5, 1, 0.5)"},
        FaultCase{"negative_reflectance", [](Scene& s) { s.materials[0].reflectance.z = -0.1f; },
                  "'material 0': reflectance"},
        FaultCase{"nan_reflectance", [](Scene& s) { s.materials[0].reflectance.x = std::nanf(""); },
                  "'material 0': reflectance"},
        FaultCase{"negative_exitance", [](Scene& s) { s.materials[0].exitance.x = -1; }, "'material 0': exitance"},
        FaultCase{"infinite_exitance", [](Scene& s) { s.materials[0].exitance.x = infinity; },
                  "'material 0': exitance"},
        FaultCase{"missing_vertex", [](Scene& s) { s.patches[1].vertices[2] = 99; }, "patch 1: a vertex index"},
        FaultCase{"missing_third_vertex", [](Scene& s) { s.patches[1].vertices[2] = none; }, "patch 1: a vertex index"},
        FaultCase{"repeated_vertices",
                  [](Scene& s) {
                      s.patches[2].vertices = {0, 1, 1, none};
                  },
                  "patch 2 has no area"},
        FaultCase{"far_vertex", [](Scene& s) { s.vertices[1].y = 1e38f; },
                  "vertex 1 is (0.5, 1e+38, 0), farther than 1e+15"},
        FaultCase{"far_origin", [](Scene& s) { s.origin.z = -1e16; },
                  "the origin is (0, 0, -1e+16), farther than 1e+15"},
        FaultCase{"nan_origin", [](Scene& s) { s.origin.z = std::nan(""); }, "the origin is not finite"},
        FaultCase{"far_contact",
                  [](Scene& s) {
                      s.contacts = {{{0, 0, 0}, {0, 2e15f, 0}}};
                  },
                  "contact 0 is ("},
        FaultCase{"wide_patch", [](Scene& s) { scale(s, 1e7f); }, "patch 0 is 1.12e+07 m wide; at most 1e+07 m"},
        FaultCase{"tiny_patch",
                  [](Scene& s) {
                      s.vertices.push_back({1e-10f, 0, 0});
                      s.vertices.push_back({0, 1e-10f, 0});
                      s.patches[0].vertices = {0, 6, 7, none};
                  },
                  "patch 0 has an area of 5e-21 m2; at least 1e-18"},
        FaultCase{"narrow_scene", [](Scene& s) { scale(s, 5e-7f); }, "the scene is only 7.07e-07 m wide"},
        FaultCase{"weak_exitance", [](Scene& s) { s.materials[0].exitance = Rgb(9e-10f); },
                  "the scene emits only 9e-10 lm/m2"},
        FaultCase{"strong_exitance", [](Scene& s) { s.materials[0].exitance.y = 1.1e10f; }, "'material 0': exitance"},
        FaultCase{"missing_material", [](Scene& s) { s.patches[0].material = 1; },
                  "patch 0: material 1 does not exist"},
        FaultCase{"missing_object", [](Scene& s) { s.patches[0].object = 1; }, "patch 0: object 1 does not exist"},
        FaultCase{"missing_other_side", [](Scene& s) { s.patches[2].other_side = PatchIndex(4); },
                  "patch 2: its other side 4"},
        FaultCase{"wrong_other_side", [](Scene& s) { s.patches[0].other_side = PatchIndex(2); },
                  "patch 0: its other side 2"},
        FaultCase{"itself_as_other_side", [](Scene& s) { s.patches[0].other_side = PatchIndex(0); },
                  "patch 0: its other side 0"},
        FaultCase{"view_without_field", [](Scene& s) { s.views[0].fov = 0; }, "view ''"},
        FaultCase{"view_from_nowhere", [](Scene& s) { s.views[0].eye.z = std::nanf(""); }, "view ''"},
        FaultCase{"view_from_afar", [](Scene& s) { s.views[0].eye.x = 1e19; },
                  "view '': (1e+19, 0, 0) is farther than"},
        FaultCase{"view_of_itself", [](Scene& s) { s.views[0].look_at = s.views[0].eye; }, "view '': eye and look-at"}),
    [](const auto& test) { return test.param.name; });

TEST(SceneFaults, OfAValidSceneAreNone) {
    EXPECT_THAT(scene_faults(valid_scene()), testing::IsEmpty());
    EXPECT_THAT(scene_faults(Scene()), testing::IsEmpty());
}

TEST(SceneFaults, AreNoneAtTheLimits) {
    Scene widest = valid_scene(), narrowest = valid_scene(), far = valid_scene();
    scale(widest, 8.9e6f);
    scale(narrowest, 7.2e-7f);
    far.origin = Imath::V3d(-1e15, 1e15, 0);
    far.views[0].eye = Imath::V3d(1e15, 0, 0);
    far.views[0].look_at = Imath::V3d(-1e15, 0, 0);
    Scene contrast = valid_scene();
    contrast.materials.push_back(contrast.materials[0]);
    contrast.materials[1].exitance = Rgb(1e-30f);
    contrast.materials[0].exitance = Rgb(1);
    EXPECT_THAT(scene_faults(contrast), testing::IsEmpty()) << "weak beside what is brighter";
    for (Scene* const scene : {&widest, &narrowest, &far})
        for (const float exitance : {0.0f, 1e-9f, 1e10f}) {
            scene->materials[0].exitance = Rgb(exitance, 0, 0);
            EXPECT_THAT(scene_faults(*scene), testing::IsEmpty()) << exitance;
        }
}

TEST(SceneFaults, AreListedUpToTwenty) {
    Scene scene = valid_scene();
    scene.vertices.resize(1000, V3f(infinity));
    EXPECT_EQ(scene_faults(scene).size(), 20u);
}

TEST(SceneFaults, NameTheObject) {
    const auto object_of = [](const auto& change) {
        Scene scene = valid_scene();
        change(scene);
        return scene_faults(scene).at(0).object;
    };
    EXPECT_EQ(object_of([](Scene& s) { s.materials[0] = {"it's 'white'", Rgb(2), Rgb(0)}; }), "it's 'white'");
    EXPECT_EQ(object_of([](Scene& s) { s.patches[1].material = 7; }), "patch 1");
    EXPECT_EQ(object_of([](Scene& s) { s.vertices[2].x = infinity; }), "vertex 2");
    EXPECT_EQ(object_of([](Scene& s) {
                  s.views[0].name = "door";
                  s.views[0].look_at = s.views[0].eye;
              }),
              "door");
}

TEST(InputErrors, KeepTheirPlace) {
    const InputError error("room.mgf", 7, "expected a colour");
    EXPECT_EQ(error.fault().file, "room.mgf");
    EXPECT_EQ(error.fault().line, 7);
    EXPECT_EQ(error.fault().text, "expected a colour");
    EXPECT_STREQ(error.what(), "room.mgf:7: expected a colour");
    EXPECT_EQ(error.faults().size(), 1u);
    EXPECT_STREQ(InputError(Fault{.text = "is empty", .file = "a.ply"}).what(), "a.ply: is empty");
    EXPECT_STREQ(InputError("expected a colour").what(), "expected a colour");
}

TEST(InputErrors, ListAllFaults) {
    Scene scene;
    scene.name = "room.mgf";
    try {
        require_no_faults({{"material 'white' is bright", "white"}, {"rays: expected more", "", "rays"}},
                          "cannot solve", scene);
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "cannot solve 'room.mgf':\n  material 'white' is bright\n  rays: expected more");
        EXPECT_EQ(error.fault().object, "white");
        EXPECT_EQ(error.faults().at(1).setting, "rays");
    }
}

}  // namespace
}  // namespace interflect
