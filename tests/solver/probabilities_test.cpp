// The weights that rays are handed out by, Eq. 3 and 8-11 of Prikryl et al. 2000, on figures that can be checked by
// hand. Seen to fail when an area is missing, or rho in Eq. 8.

#include "interflect/solver/probabilities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace interflect {
namespace {

using testing::ElementsAre;

/// A square of 4 m^2 that reflects 1/4, 1/2 and 3/4 of the channels and is divided in four, and a black one of
/// 2 m^2.
class Weights : public testing::Test {
  protected:
    Weights() {
        forest_.subdivide(0);
        leaves_ = forest_.leaves();
    }
    static Scene two_squares() {
        Scene scene;
        testing_support::add_material(scene, {0.25f, 0.5f, 0.75f}, Rgb(0));
        testing_support::add_material(scene, Rgb(0), Rgb(1));
        testing_support::add_rectangle(scene, V3f(0), {2, 0, 0}, {0, 2, 0}, 0);
        testing_support::add_rectangle(scene, {5, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
        return scene;
    }
    Sampled sampled() const { return {surfaces_, forest_, leaves_, radiosity_, view_, indirect_}; }

    const Scene scene_ = two_squares();
    const Surfaces surfaces_{scene_};
    ElementForest forest_{scene_, 6};
    std::vector<std::uint32_t> leaves_;
    // By element: the divided square, the black one, the parts of the first.
    std::vector<Rgb> radiosity_{Rgb(9), Rgb(2), Rgb(1, 2, 3), Rgb(0), Rgb(0, 0, 1), Rgb(1)};
    std::vector<float> view_{9, 1, 0, 2, 0, 0.5f}, indirect_{9, 0, 3, 1, 0, 0.25f};
};

TEST_F(Weights, OfPowerAreTheSumOfTheChannelsTimesTheArea) {
    EXPECT_THAT(power_weights(sampled()), ElementsAre(12, 6, 0, 1, 3));
}

TEST_F(Weights, OfPowerAreFiniteForEveryFiniteRadiosity) {
    radiosity_.assign(6, Rgb(std::numeric_limits<float>::max()));
    for (const double w : power_weights(sampled())) EXPECT_TRUE(std::isfinite(w));
}

TEST_F(Weights, OfImportanceAreWhatIsReflectedOfAllOfIt) {
    EXPECT_THAT(importance_weights(sampled()), ElementsAre(0, 1.5, 1.5, 0, 0.375));
}

TEST_F(Weights, OfPowerAndImportanceTakeAllOfItOrWithoutTheEyesOrTheEyesAlone) {
    EXPECT_THAT(total_importance_weights(sampled()), ElementsAre(12, 18, 0, 0, 2.25));
    EXPECT_THAT(indirect_importance_weights(sampled()), ElementsAre(0, 18, 0, 0, 0.75));
    EXPECT_THAT(view_weights(sampled()), ElementsAre(12, 0, 0, 0, 1.5));
}

TEST_F(Weights, OfImportanceAreZeroWithoutAView) {
    view_.clear(), indirect_.clear();
    EXPECT_THAT(importance_weights(sampled()), ElementsAre(0, 0, 0, 0, 0));
    EXPECT_THAT(indirect_importance_weights(sampled()), ElementsAre(0, 0, 0, 0, 0));
}

TEST(MixIn, AddsAShareOfADistribution) {
    std::vector<double> q(2, 0.0);
    mix_in(q, {30, 10}, 0.8);
    mix_in(q, {0, 0}, 0.1);  // is no distribution: its share goes to the others
    mix_in(q, {0, 7}, 0.1);
    EXPECT_THAT(q, ElementsAre(testing::DoubleNear(0.6, 1e-15), testing::DoubleNear(0.3, 1e-15)));
}

}  // namespace
}  // namespace interflect
