#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "interflect/base/error.h"
#include "interflect/scene/contacts.h"
#include "interflect/scene/scene.h"
#include "interflect/scene/split.h"
#include "tests/support/scenes.h"

namespace interflect {
namespace {

using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Two two-sided faces, one material, one view: nothing wrong with it.
Scene valid_scene() {
    Scene scene;
    testing_support::add_material(scene, Rgb(0.5f), Rgb(1));
    testing_support::add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 2, 1, true);
    scene.views = {View()};
    return scene;
}

struct Fault {
    const char* name;
    std::function<void(Scene&)> make;
    const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

class SceneFaults : public testing::TestWithParam<Fault> {};

TEST_P(SceneFaults, AreFoundAndNamed) {
    Scene scene = valid_scene();
    GetParam().make(scene);
    const std::vector<std::string> faults = scene_faults(scene);
    ASSERT_FALSE(faults.empty());
    EXPECT_THAT(faults[0], HasSubstr(GetParam().message));
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
        Fault{"nan_vertex", [](Scene& s) { s.vertices[1].y = std::nanf(""); }, "vertex 1 is not finite"},
        Fault{"infinite_vertex", [](Scene& s) { s.vertices[0].x = infinity; }, "vertex 0 is not finite"},
        Fault{"reflectance_of_one", [](Scene& s) { s.materials[0].reflectance.y = 1; }, "reflectance (0.5, 1, 0.5)"},
        Fault{"negative_reflectance", [](Scene& s) { s.materials[0].reflectance.z = -0.1f; },
              "'material 0': reflectance"},
        Fault{"nan_reflectance", [](Scene& s) { s.materials[0].reflectance.x = std::nanf(""); },
              "'material 0': reflectance"},
        Fault{"negative_exitance", [](Scene& s) { s.materials[0].exitance.x = -1; }, "'material 0': exitance"},
        Fault{"infinite_exitance", [](Scene& s) { s.materials[0].exitance.x = infinity; }, "'material 0': exitance"},
        Fault{"missing_vertex", [](Scene& s) { s.patches[1].vertices[2] = 99; }, "patch 1: a vertex index"},
        Fault{"missing_third_vertex", [](Scene& s) { s.patches[1].vertices[2] = none; }, "patch 1: a vertex index"},
        Fault{"repeated_vertices",
              [](Scene& s) {
                  s.patches[2].vertices = {0, 1, 1, none};
              },
              "patch 2 has no area"},
        Fault{"missing_material", [](Scene& s) { s.patches[0].material = 1; }, "patch 0: there is no material 1"},
        Fault{"missing_object", [](Scene& s) { s.patches[0].object = 1; }, "patch 0: there is no object 1"},
        Fault{"missing_other_side", [](Scene& s) { s.patches[2].other_side = 4; }, "patch 2: its other side 4"},
        Fault{"wrong_other_side", [](Scene& s) { s.patches[0].other_side = 2; }, "patch 0: its other side 2"},
        Fault{"itself_as_other_side", [](Scene& s) { s.patches[0].other_side = 0; }, "patch 0: its other side 0"},
        Fault{"view_without_field", [](Scene& s) { s.views[0].fov = 0; }, "view ''"},
        Fault{"view_from_nowhere", [](Scene& s) { s.views[0].eye.z = std::nanf(""); }, "view ''"}),
    [](const auto& test) { return test.param.name; });

TEST(SceneFaults, OfAValidSceneAreNone) {
    EXPECT_EQ(scene_faults(valid_scene()), std::vector<std::string>());
    EXPECT_EQ(scene_faults(Scene()), std::vector<std::string>());
}

TEST(SceneFaults, AreListedUpToTwenty) {
    Scene scene = valid_scene();
    scene.vertices.resize(1000, V3f(infinity));
    EXPECT_EQ(scene_faults(scene).size(), 20u);
}

}  // namespace
}  // namespace interflect
