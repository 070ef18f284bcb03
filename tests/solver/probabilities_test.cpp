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
    Sampled sampled() const { return {surfaces_, forest_, leaves_}; }

    const Scene scene_ = two_squares();
    const Surfaces surfaces_{scene_};
    ElementForest forest_{scene_, 6};
    std::vector<std::uint32_t> leaves_;
    // By element: the divided square, the black one, the parts of the first.
    std::vector<Rgb> radiosity_{Rgb(9), Rgb(2), Rgb(1, 2, 3), Rgb(0), Rgb(0, 0, 1), Rgb(1)};
    std::vector<float> importance_{9, 1, 3, 3, 0, 0.75f};
};

TEST_F(Weights, OfPowerAreTheSumOfTheChannelsTimesTheArea) {
    EXPECT_THAT(power_weights(sampled(), radiosity_), ElementsAre(12, 6, 0, 1, 3));
}

TEST_F(Weights, OfPowerAreFiniteForEveryFiniteRadiosity) {
    radiosity_.assign(6, Rgb(std::numeric_limits<float>::max()));
    for (const double w : power_weights(sampled(), radiosity_)) EXPECT_TRUE(std::isfinite(w));
}

TEST_F(Weights, OfImportanceAreWhatIsReflectedOfIt) {
    EXPECT_THAT(reflected_importance_weights(sampled(), importance_), ElementsAre(0, 1.5, 1.5, 0, 0.375));
}

TEST_F(Weights, OfPowerThatIsDrivenAreTheProduct) {
    EXPECT_THAT(driven_weights(sampled(), radiosity_, importance_), ElementsAre(12, 18, 0, 0, 2.25));
}

TEST_F(Weights, AreDrivenByImportanceAsItIsUnlessItIsSmoothed) {
    EXPECT_EQ(driving_importance(forest_, importance_, 0, 1), importance_);
    EXPECT_THAT(driving_importance(forest_, importance_, 1, 1), ElementsAre(9, 1, 9, 9, 9, 9));
    EXPECT_THAT(driving_importance(forest_, importance_, 0.5, 1), ElementsAre(9, 1, 6, 6, 4.5f, 4.875f));
    EXPECT_THAT(driving_importance(forest_, importance_, 0.5, 0.5),
                ElementsAre(3, 1, std::sqrt(6.0f), std::sqrt(6.0f), std::sqrt(4.5f), std::sqrt(4.875f)));
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
