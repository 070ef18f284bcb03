// Visible differences: each factor of the threshold on elements that differ in one respect, and its share of
// refinement.
//
// Seen to fail: adaptation to the mean of the picture or to the leaf alone; exposure by the arithmetic mean; no spatial
// frequency, or the period of a single child; no masking, or another exponent; no rho; a square degree that ignores the
// weights of the views; refinement of all visible leaves, of none, or with the limit of the variance criterion for
// shifted light.

#include "interflect/solver/refinement/visible_difference.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/image/tone/visual_adaptation.h"
#include "interflect/solve.h"
#include "interflect/solver/refinement/variance_refinement.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/textured_scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr float rho = 0.5f;

/// A white cube of side 2 m, four patches a wall. Two patches, 12 and 13, have the same size in the picture.
Scene cube() { return closed_box({2, 2, 2}, 2, {{"wall", Rgb(rho), Rgb(1)}}); }

WeightedView view_of_patches() {
    WeightedView view;
    view.view = {"view", {1, 0.1, 1}, {1, 2, 1}, {0, 0, 1}, 60};
    return view;
}

SolveOptions perceptual(const std::vector<WeightedView>& views = {view_of_patches()}) {
    SolveOptions options{.method = find_method("ihsrr"), .views = views};
    options.refinement.criterion = RefinementCriterion::perceptual;
    return options;
}

/// State with an irradiance of 1, equal importance of all surfaces, and no rays.
struct Threshold {
    Scene scene;
    RayCaster ray_caster;
    SolverState state;

    explicit Threshold(Scene s = cube(), const SolveOptions& options = perceptual())
        : scene(std::move(s)), ray_caster(scene), state(scene, ray_caster, options) {
        reset();
    }
    void reset() {
        const ElementForest& forest = *state.light.forest;
        float area = 0;
        for (PatchIndex i{0}; i < forest.patch_count(); ++i) area += forest.area(i);
        state.light.solution.irradiance.assign(forest.size(), Rgb(1));
        state.light.solution.view_importance.assign(forest.size(), 1 / area);
        state.light.solution.indirect_importance.assign(forest.size(), 1 / area);
        state.light.history.assign(forest.size(), 0);
    }
    /// Divides the first child again and again; returns the last one.
    ElementIndex divide(ElementIndex element, int levels) {
        const std::uint32_t before = state.light.forest->size();
        for (int k = 0; k < levels; ++k) element = state.light.forest->subdivide(element);
        grow_with_forest(state, before);
        reset();
        return element;
    }
    void set(ElementIndex element, float irradiance) { state.light.solution.irradiance[element] = Rgb(irradiance); }
    /// Threshold of luminance.
    float threshold(ElementIndex leaf) const {
        return std::sqrt(VisibleDifference(state.inputs, state.light).threshold(leaf));
    }
};

TEST(VisibleDifference, AdaptsToLocalLight) {
    Threshold s;
    s.set(ElementIndex(13), 0.2f);
    const float shown = 20 / std::pow(0.2f, 1.0f / 24);  // logarithmic mean: one patch of 1 m^2 in 24 m^2
    EXPECT_NEAR(s.threshold(ElementIndex(13)) / s.threshold(ElementIndex(12)),
                cone_threshold(0.2f * shown) / cone_threshold(shown), 0.01);
    s.set(ElementIndex(13), 1e-6f);
    EXPECT_NEAR(s.threshold(ElementIndex(13)) / s.threshold(ElementIndex(12)),
                cone_threshold(0.5f) / cone_threshold(20 * std::pow(1e6f, 1.0f / 24)), 0.01)
        << "black of display";
    s.set(ElementIndex(13), 1e4f);
    EXPECT_NEAR(s.threshold(ElementIndex(13)) / s.threshold(ElementIndex(12)),
                cone_threshold(100) / cone_threshold(20 / std::pow(1e4f, 1.0f / 24)), 0.1)
        << "white of display";
}

TEST(VisibleDifference, AdaptsToASquareDegree) {
    Threshold s;
    const ElementForest& forest = *s.state.light.forest;
    const ElementIndex leaf = s.divide(ElementIndex(12), 4), parent = forest.parent(leaf);
    const ElementIndex degree = forest.parent(forest.parent(parent));  // 118 pixels wide; its children 59
    const float before = s.threshold(leaf);
    s.set(leaf, 0.1f);
    s.set(parent, 0.1f);
    EXPECT_NEAR(s.threshold(leaf) / before, 1, 0.001f);
    s.set(degree, 0.1f);
    EXPECT_LT(s.threshold(leaf) / before, 0.5f);
}

TEST(VisibleDifference, FollowsTheUnitOfLight) {
    Threshold s;
    const float before = s.threshold(ElementIndex(12));
    for (Rgb& h : s.state.light.solution.irradiance) h *= 1000;
    EXPECT_NEAR(s.threshold(ElementIndex(12)) / before, 1000, 0.1);
}

/// A fifth of the flash threshold, 1.63 cd/m^2 at 20 cd/m^2, relative to the light.
TEST(VisibleDifference, IsASixtiethAtMediumLight) {
    EXPECT_NEAR(Threshold().threshold(ElementIndex(12)), 0.0163f, 0.0002f);
}

TEST(VisibleDifference, SparesSmallElements) {
    Threshold s;
    const float large = s.threshold(ElementIndex(12));
    for (int levels = 1, deepest = 7; levels <= deepest; ++levels) {
        Threshold divided;
        const ElementIndex leaf = divided.divide(ElementIndex(12), levels);
        const float width = std::sqrt(divided.state.light.forest->area(leaf) /
                                      pixel_area(divided.state.inputs, divided.state.light, leaf));
        const double frequency = 67.02 / std::max(1.0, static_cast<double>(width));
        const double factor = contrast_sensitivity(8) / contrast_sensitivity(std::max(8.0, frequency));
        EXPECT_NEAR(divided.threshold(leaf) / large, factor, 0.01 * factor) << width << " pixels";
        if (levels == deepest) {
            EXPECT_GT(factor, 3);
        }
    }
}

/// Daly 1993: maskers below the threshold have no effect, others raise it with exponent 0.7.
TEST(VisibleDifference, IsRaisedByMaskers) {
    EXPECT_EQ(threshold_elevation(0), 1);
    EXPECT_NEAR(threshold_elevation(0.1f), 1, 0.001f);
    EXPECT_NEAR(threshold_elevation(1), std::pow(2, 0.25), 0.002f);
    EXPECT_NEAR(threshold_elevation(1000) / threshold_elevation(100), std::pow(10, 0.7), 0.001f);
}

TEST(VisibleDifference, IsMaskedByTexture) {
    WeightedView view;
    view.view = {"floor", {2, 1, 1.9}, {2, 1.001, 0}, {0, 1, 0}, 80};
    Threshold textured(half_dark_floor(Halves::reflect), perceptual({view}));
    const PatchIndex floor(textured.state.light.forest->patch_count() - 1);
    const ElementIndex first = textured.divide(floor, 1);
    const auto reflectance = [&](ElementIndex e) {
        return luminance(textured.state.inputs.materials.surface(floor, e).reflectance);
    };
    ASSERT_LT(reflectance(first), 0.02f);
    const float bright = reflectance(first + 1);
    ASSERT_NEAR(bright, 0.8f, 0.02f);
    const float threshold = textured.threshold(first + 1);
    // The texture without its neighbour: the bright half as a patch of its own.
    Threshold plain(half_dark_floor_of_two_patches(Halves::reflect), perceptual({view}));
    const float unmasked = plain.threshold(PatchIndex(plain.state.light.forest->patch_count() - 1));
    EXPECT_NEAR(threshold / unmasked, threshold_elevation(0.5f / unmasked), 0.15f * threshold / unmasked);
    EXPECT_GT(threshold, 5 * unmasked);
}

TEST(VisibleDifference, IsInfiniteWhereNothingShows) {
    Threshold s;
    s.state.light.solution.view_importance[12] = 0;
    EXPECT_TRUE(std::isinf(s.threshold(ElementIndex(12))));
    EXPECT_TRUE(std::isfinite(s.threshold(ElementIndex(13))));
    Threshold black(closed_box({2, 2, 2}, 1, {{"black", Rgb(0), Rgb(1)}}));
    EXPECT_TRUE(std::isinf(black.threshold(ElementIndex(3))));
}

TEST(VisibleDifference, OfOtherSurfacesIsThatOfASquareDegree) {
    const double contrast = 0.2 * cone_threshold(20) / 20, square_degree = 67.02 * 67.02 / (1280 * 720);
    const Threshold standard;
    EXPECT_NEAR(VisibleDifference(standard.state.inputs, standard.state.light).share_of_light(),
                contrast * square_degree, 1e-9);
    WeightedView small = view_of_patches(), large = view_of_patches();
    small.pixel_rows = 360;
    large.weight = 8;
    const Threshold two(cube(), perceptual({small, large}));
    EXPECT_NEAR(VisibleDifference(two.state.inputs, two.state.light).share_of_light(), contrast * square_degree * 8 / 9,
                1e-9);
}

/// The children of two patches differ by more and by less than the threshold, without noise.
TEST(PerceptualRefinement, SplitsVisibleDifferences) {
    Threshold s;
    const ElementIndex clear = s.divide(ElementIndex(12), 1), faint = s.divide(ElementIndex(13), 1);
    std::fill(s.state.light.solution.indirect_importance.begin(), s.state.light.solution.indirect_importance.end(),
              0.0f);
    const float threshold = s.threshold(clear);
    s.state.light.history.assign(s.state.light.forest->size(), 1000);
    const auto differ = [&](ElementIndex first, float signal) {
        const float difference = signal / std::sqrt(0.3f);  // falls to 0.3 of the square within the children
        for (const std::uint32_t k : {0u, 1u}) {
            s.set(first + k, 1 + difference);
            s.set(first + 2 + k, 1 - difference);
        }
    };
    differ(clear, 1.3f * threshold);
    differ(faint, 0.8f * threshold);
    refine_by_variance(s.state);
    for (std::uint32_t k = 0; k < 4; ++k) {
        EXPECT_FALSE(s.state.light.forest->is_leaf(clear + k));
        EXPECT_TRUE(s.state.light.forest->is_leaf(faint + k));
    }
}

/// The view shows a part of the floor; variance resolves the light on the other surfaces, too.
Solution solved(RefinementCriterion criterion, std::uint64_t seed = 1) {
    const Scene scene = half_dark_floor(Halves::reflect);
    WeightedView view;
    view.view = {"floor", {2, 1, 1.9}, {2.5, 1, 0}, {0, 1, 0}, 40};
    SolveOptions options = perceptual({view});
    options.refinement.criterion = criterion;
    options.limits.rays = 500'000;
    options.seed = seed;
    return solve(scene, RayCaster(scene), options);
}

TEST(PerceptualRefinement, NeedsFewerElements) {
    RELEASE_ONLY();
    const Solution variance = solved(RefinementCriterion::variance), visible = solved(RefinementCriterion::perceptual);
    EXPECT_LT(visible.iterations.back().elements, 0.85 * static_cast<double>(variance.iterations.back().elements));
}

/// The criterion refers to pictures, so it needs full importance.
TEST(PerceptualRefinement, IsRefusedWithoutPictures) {
    const Scene scene = cube();
    const auto refuses = [&](const auto& change) {
        SolveOptions options = perceptual();
        change(options);
        EXPECT_THROW(solve(scene, RayCaster(scene), options), InputError);
    };
    refuses([](SolveOptions& o) { o.views.clear(); });
    refuses([](SolveOptions& o) { o.method = find_method("hsrr"); });
    refuses([](SolveOptions& o) { o.method.importance = ImportanceUse::direct; });
    refuses([](SolveOptions& o) { o.experimental.one_bounce = true; });
}

/// A view that shows no surface leaves refinement to the variance.
TEST(PerceptualRefinement, IsByVarianceIfNothingIsVisible) {
    WeightedView outwards = view_of_patches();
    outwards.view.eye = {1, 30, 1}, outwards.view.look_at = {1, 60, 1};
    SolveOptions options = perceptual({outwards});
    options.limits.rays = 100'000;
    const Scene scene = cube();
    const Solution visible = solve(scene, RayCaster(scene), options);
    options.refinement.criterion = RefinementCriterion::variance;
    EXPECT_EQ(visible.irradiance, solve(scene, RayCaster(scene), options).irradiance);
}

}  // namespace
}  // namespace interflect
