#include "interflect/scene/view.h"

#include <ImathBox.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interflect/error.h"
#include "tests/support/scenes.h"

namespace interflect {
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

}  // namespace
}  // namespace interflect
