#include "interflect/scene/core/view.h"

#include <ImathBox.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "interflect/core.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string error_of(const Scene& scene, const std::string& name) {
    try {
        find_view(scene, name);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

TEST(FindView, FindsAViewByItsName) {
    Scene scene;
    scene.views.resize(2);
    scene.views[0].name = "door";
    scene.views[1].name = "desk";
    EXPECT_EQ(&find_view(scene, "desk"), &scene.views[1]);
}

TEST(FindView, ListsTheViewsThereAre) {
    Scene scene;
    scene.name = "room.mgf";
    EXPECT_THAT(error_of(scene, "desk"),
                AllOf(HasSubstr("room.mgf: "), HasSubstr("'desk'"), HasSubstr("it names none")));
    scene.views.resize(2);
    scene.views[0].name = "door";
    scene.views[1].name = "window";
    EXPECT_THAT(error_of(scene, "desk"), HasSubstr("it names: door, window"));
}

TEST(Overview, LooksFromInsideTheScenesBoxTowardsItsMiddle) {
    Scene scene = testing_support::closed_box({4, 6, 3}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    for (V3f& v : scene.vertices) v += V3f(10, -20, 5);
    const View view = overview(scene);
    const Imath::Box3f box(V3f(10, -20, 5), V3f(14, -14, 8));
    EXPECT_TRUE(box.intersects(V3f(view.eye)));
    EXPECT_GT(view.eye.z, 6.5f) << "from high up";
    EXPECT_LT((V3f(view.look_at) - box.center()).length(), 1e-5f);
    EXPECT_EQ(view.up, V3f(0, 0, 1));
    scene.views = {view};
    EXPECT_TRUE(scene_faults(scene).empty());
}

/// A box from (10, -20, 5) to (14, -14, 8).
Scene box_elsewhere() {
    Scene scene = testing_support::closed_box({4, 6, 3}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    scene.origin = Imath::V3d(10, -20, 5);
    return scene;
}

TEST(CutView, OfAPlanShowsAllOfTheSceneFromTheCutDown) {
    const View plan = cut_view(box_elsewhere(), Imath::V3d(0, 0, 6.2), Imath::V3d(0, 0, -2), 1.0f);
    EXPECT_LT((plan.eye - Imath::V3d(12, -17, 6.2)).length(), 1e-6);
    EXPECT_LT(((plan.look_at - plan.eye).normalized() - Imath::V3d(0, 0, -1)).length(), 1e-9);
    EXPECT_EQ(plan.up, V3f(0, 1, 0));
    EXPECT_FLOAT_EQ(plan.extent, 1.04f * 6);
    EXPECT_FLOAT_EQ(cut_view(box_elsewhere(), Imath::V3d(0), Imath::V3d(0, 0, -1), 0.5f).extent, 1.04f * 8) << "4 wide";
}

TEST(CutView, OfASectionHasZUpwards) {
    const View section = cut_view(box_elsewhere(), Imath::V3d(11, 0, 0), Imath::V3d(1, 0, 0), 4.0f);
    EXPECT_LT((section.eye - Imath::V3d(11, -17, 6.5)).length(), 1e-6);
    EXPECT_EQ(section.up, V3f(0, 0, 1));
    EXPECT_FLOAT_EQ(section.extent, 1.04f * 3);
    EXPECT_EQ(view_fault(section), "");
}

TEST(CutView, AtAnAngleShowsTheWholeBox) {
    const View section = cut_view(box_elsewhere(), Imath::V3d(12, -17, 0), Imath::V3d(1, 1, 0), 1.0f);
    EXPECT_LT((section.eye - Imath::V3d(12, -17, 6.5)).length(), 1e-6);
    EXPECT_FLOAT_EQ(section.extent, 1.04f * 10 / std::sqrt(2.0f));
}

}  // namespace
}  // namespace interflect
