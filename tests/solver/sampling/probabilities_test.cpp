// Sampling weights of rays, Eq. 3 and 8-11 of Prikryl et al. 2000, on values that can be checked by hand. Seen to fail
// if an area is missing, if rho is missing in Eq. 8, or if infinite weights are kept or not counted.
#include "interflect/solver/sampling/probabilities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "interflect/elements/forest.h"
#include "interflect/solver/importance/importance_weights.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing::AnyOf;
using testing::Each;
using testing::ElementsAre;
using testing::FloatEq;

/// A divided square of 4 m^2 with reflectances 1/4, 1/2 and 3/4, and a black square of 2 m^2.
class Weights : public testing::Test {
  protected:
    Weights() { forest_.subdivide(ElementIndex(0)); }
    static Scene two_squares() {
        Scene scene;
        testing_support::add_material(scene, {0.25f, 0.5f, 0.75f}, Rgb(0));
        testing_support::add_material(scene, Rgb(0), Rgb(1));
        testing_support::add_rectangle(scene, V3f(0), {2, 0, 0}, {0, 2, 0}, 0);
        testing_support::add_rectangle(scene, {5, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
        return scene;
    }
    SamplingWeights sampled() const {
        return {materials_, forest_, Radiosity(materials_, irradiance_), Importance(importance_), importance_, nearby_};
    }
    template <class Weight>
    std::vector<double> of_leaves(const Weight& weight) const {
        std::vector<double> weights;
        for (const ElementIndex leaf : forest_.leaves()) weights.push_back(std::invoke(weight, sampled(), leaf));
        return weights;
    }

    const Scene scene_ = two_squares();
    const Materials materials_{scene_};
    ElementForest forest_{scene_, 6};
    // Per element: the divided square, the black square, the children of the first.
    std::vector<Rgb> irradiance_{Rgb(9), Rgb(2), Rgb(4, 4, 4), Rgb(0), Rgb(0, 0, 4), Rgb(4)};
    std::vector<float> importance_{9, 1, 3, 3, 0, 0.75f};
    std::vector<float> nearby_{2, 5};  // of the two squares
};

TEST_F(Weights, OfPowerAreTheSumOfTheChannelsTimesTheArea) {
    EXPECT_THAT(of_leaves(&SamplingWeights::power), ElementsAre(6, 6, 0, 3, 6));
}

TEST_F(Weights, OfWhatIsNotFiniteAreZeroAndItIsReported) {
    irradiance_[2].y = std::numeric_limits<float>::infinity();
    irradiance_[5].x = std::nanf("");
    const Radiosity light(materials_, irradiance_);
    EXPECT_THAT(of_leaves(&SamplingWeights::power), ElementsAre(6, 0, 0, 3, 0));
    for (ElementIndex e{0}; e < 6; ++e) EXPECT_EQ(light.is_not_finite(forest_, e), e == 2 || e == 5) << e;
}

TEST_F(Weights, OfPowerAreFiniteForEveryFiniteRadiosity) {
    irradiance_.assign(6, Rgb(std::numeric_limits<float>::max()));
    for (const double w : of_leaves(&SamplingWeights::power)) EXPECT_TRUE(std::isfinite(w));
}

TEST_F(Weights, OfImportanceAreWhatIsReflectedOfIt) {
    EXPECT_THAT(of_leaves(&SamplingWeights::importance), ElementsAre(0, 1.5, 1.5, 0, 0.375));
}

TEST_F(Weights, OfPowerThatIsDrivenAreTheProduct) {
    EXPECT_THAT(of_leaves(&SamplingWeights::weighted_power), ElementsAre(6, 18, 0, 0, 4.5));
}

TEST_F(Weights, AreMixedInTheirSharesAndNoneForInnerElements) {
    using testing::FloatNear;
    EXPECT_THAT(mixture(sampled(), {.power = 0.42}).q,
                ElementsAre(0, FloatNear(0.12f, 1e-7f), FloatNear(0.12f, 1e-7f), 0, FloatNear(0.06f, 1e-7f),
                            FloatNear(0.12f, 1e-7f)));
    const std::vector<float> q = mixture(sampled(), {.power = 0.21, .weighted_power = 0.285, .importance = 0.3375}).q;
    EXPECT_THAT(
        q, ElementsAre(0, FloatNear(0.06f + 0.06f, 1e-7f), FloatNear(0.06f + 0.18f + 0.15f, 1e-7f),
                       FloatNear(0.15f, 1e-7f), FloatNear(0.03f, 1e-7f), FloatNear(0.06f + 0.045f + 0.0375f, 1e-7f)));
}

TEST_F(Weights, AreDrivenByTheImportanceNearbyOfWholePatches) {
    using testing::FloatNear;
    EXPECT_THAT(of_leaves(&SamplingWeights::power_nearby), ElementsAre(30, 12, 0, 6, 12));
    EXPECT_THAT(mixture(sampled(), {.power = 0.21, .power_nearby = 0.6}).q,
                ElementsAre(0, FloatNear(0.06f + 0.3f, 1e-7f), FloatNear(0.06f + 0.12f, 1e-7f), 0,
                            FloatNear(0.03f + 0.06f, 1e-7f), FloatNear(0.06f + 0.12f, 1e-7f)));
}

TEST_F(Weights, ThatAre0EverywhereLeaveTheirShareToTheOthers) {
    importance_.assign(6, 0.0f);
    EXPECT_EQ(mixture(sampled(), {.power = 0.5, .weighted_power = 0.3, .importance = 0.2}).q,
              mixture(sampled(), {.power = 0.5}).q);
}

TEST_F(Weights, CountTheLeavesOfWhichNothingFiniteCanBeShot) {
    irradiance_[0].x = irradiance_[2].y = irradiance_[4].z = std::numeric_limits<float>::infinity();
    const Mixture mixed = mixture(sampled(), {.power = 1});
    EXPECT_EQ(mixed.non_finite_leaves, 2) << "and the inner element is none";
    EXPECT_EQ(mixed.q[2], 0);
    EXPECT_EQ(mixed.q[4], 0);
}

TEST_F(Weights, AreFiniteShares) {
    irradiance_.assign(6, Rgb(std::numeric_limits<float>::max()));
    float sum = 0;
    for (const float q : mixture(sampled(), {.power = 1}).q) sum += q;
    EXPECT_FLOAT_EQ(sum, 1);
}

TEST_F(Weights, AreDrivenByImportanceAsItIsUnlessItIsSmoothed) {
    EXPECT_EQ(smoothed_importance(forest_, Importance(importance_), 0, 1), importance_);
    EXPECT_THAT(smoothed_importance(forest_, Importance(importance_), 1, 1), ElementsAre(9, 1, 9, 9, 9, 9));
    EXPECT_THAT(smoothed_importance(forest_, Importance(importance_), 0.5, 1), ElementsAre(9, 1, 6, 6, 4.5f, 4.875f));
    EXPECT_THAT(smoothed_importance(forest_, Importance(importance_), 1, 0.75),
                Each(AnyOf(FloatEq(std::pow(9.0f, 0.75f)), 1)));
    EXPECT_THAT(smoothed_importance(forest_, Importance(importance_), 0.5, 0.5),
                ElementsAre(3, 1, std::sqrt(6.0f), std::sqrt(6.0f), std::sqrt(4.5f), std::sqrt(4.875f)));
}

}  // namespace
}  // namespace interflect
