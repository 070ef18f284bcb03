// View importance V, and the importance used by the oracle.
//
// Seen to fail if a second set of camera rays replaces the weights of the first, if points stay with the elements in
// which they were first found, or if the oracle uses unsmoothed importance.

#include "interflect/solver/importance/view_importance.h"

#include <gtest/gtest.h>

#include "interflect/elements/forest.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/refinement/oracle_threshold.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const View at_x0{"x = 0", {1, 0.5f, 0.5f}, {0, 0.5f, 0.5f}, {0, 0, 1}, 20};
const View at_x2{"x = 2", {1, 0.5f, 0.5f}, {2, 0.5f, 0.5f}, {0, 0, 1}, 20};
constexpr PatchIndex wall_x0(0), wall_x2(1);

struct Box {
    Scene scene = closed_box({2, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
    RayCaster ray_caster{scene};
    Panes panes{scene, ray_caster};
    ElementForest forest{scene, 1000};

    double share(const std::vector<float>& v, PatchIndex patch) const { return v[patch] * forest.area(patch); }
};

TEST(ViewImportance, IsTheViewsByTheirWeightsHoweverOftenTheyAreLookedAt) {
    Box box;
    const std::vector<WeightedView> views{{at_x0, 3, 1}, {at_x2, 1, 1}};
    ViewImportance view(views, 1);
    EXPECT_TRUE(view.empty());
    for (const int rays : {100, 2500}) {  // squares, which give exactly this number of rays
        view.trace_view_rays(box.forest, box.ray_caster, box.panes, rays);
        const std::vector<float> v = view.per_area(box.forest, false);
        EXPECT_NEAR(box.share(v, wall_x0), 0.75, 1e-6);
        EXPECT_NEAR(box.share(v, wall_x2), 0.25, 1e-6);
    }
    EXPECT_EQ(view.rays(), 2 * 2600);
}

TEST(ViewImportance, FollowsTheMesh) {
    Box box;
    const std::vector<WeightedView> views{{at_x0, 1, 1}};
    ViewImportance view(views, 1), later(views, 1);
    view.trace_view_rays(box.forest, box.ray_caster, box.panes, 10'000);
    view.per_area(box.forest, false);
    const ElementIndex grandchild = box.forest.subdivide(box.forest.subdivide(wall_x0) + 3);
    later.trace_view_rays(box.forest, box.ray_caster, box.panes, 10'000);
    const std::vector<float> v = view.per_area(box.forest, false);
    EXPECT_EQ(v, later.per_area(box.forest, false));
    EXPECT_NEAR(box.share(v, wall_x0), 1, 1e-6);
    EXPECT_GT(v[grandchild], 1) << "at the middle of the wall, where the view looks";
    EXPECT_EQ(v[grandchild + 3], 0) << "in its corner";
    EXPECT_EQ(view.per_area(box.forest, true)[box.forest.first_child(wall_x0)], v[wall_x0]) << "even over the patch";
}

TEST(ImportanceOfTheOracle, LeansOnTheParents) {
    const Box box;
    const auto forest = std::make_shared<ElementForest>(box.scene, 1000);
    const ElementIndex child = forest->subdivide(wall_x0), grandchild = forest->subdivide(child);
    Solution solution;
    solution.forest = forest;
    solution.options.method = find_method("ihsrr");
    solution.options.importance.smoothing = 0.5;
    solution.view_importance.assign(forest->size(), 1.0f);
    solution.indirect_importance.assign(forest->size(), 1.0f);
    solution.view_importance[child] = 0;
    solution.indirect_importance[grandchild] = 5;
    solution.irradiance.assign(forest->size(), Rgb(1));
    const Oracle oracle = make_oracle(solution, 1, 0);
    EXPECT_EQ(oracle.importance[wall_x0], 2);
    EXPECT_EQ(oracle.importance[child], 1.5f) << "half of 1, half of the parent's 2";
    EXPECT_EQ(oracle.importance[grandchild], 3.75f) << "half of 6, half of the parent's 1.5";
    solution.options.importance.smoothing = 0;
    EXPECT_EQ(make_oracle(solution, 1, 0).importance, total_importance(solution)) << "as in the paper";
}

}  // namespace
}  // namespace interflect
