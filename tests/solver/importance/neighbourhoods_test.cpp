// Means over neighbouring patches, which prevent small lamps from appearing unimportant. Seen to fail
// (scripts/mutation-test) if patches are not weighted by area, or if neighbourhoods do not pass on the values of the
// next larger ones.
#include "interflect/solver/importance/neighbourhoods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "interflect/elements/forest.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::Each;
using testing::FloatNear;

struct Walls {
    Scene scene = closed_box({1, 2, 4}, 3, {{"wall", Rgb(0.5f), Rgb(1)}});  // 6 walls of 9 patches
    ElementForest forest{scene, scene.patches.size()};
    Neighbourhoods neighbourhoods{forest};

    std::vector<float> smoothed(std::vector<float> values, float share) const {
        neighbourhoods.smooth(forest, values, share);
        return values;
    }
    double area_mean(const std::vector<float>& values) const {
        double sum = 0, area = 0;
        for (PatchIndex p{0}; p < forest.patch_count(); ++p) {
            sum += static_cast<double>(values[p]) * forest.area(p);
            area += forest.area(p);
        }
        return sum / area;
    }
};

TEST(Neighbourhoods, KeepWhatIsTheSameEverywhere) {
    const Walls w;
    EXPECT_THAT(w.smoothed(std::vector<float>(54, 3.0f), 0.7f), Each(FloatNear(3, 1e-5f)));
}

TEST(Neighbourhoods, TakeOverNothingOrAllOfTheMean) {
    const Walls w;
    std::vector<float> values(54, 0.0f);
    values[10] = 1;
    EXPECT_EQ(w.smoothed(values, 0), values);
    EXPECT_THAT(w.smoothed(values, 1), Each(FloatNear(static_cast<float>(w.area_mean(values)), 1e-6f)));
}

TEST(Neighbourhoods, KeepTheMeanAndGiveMostToWhatIsNear) {
    const Walls w;
    std::vector<float> values(54, 0.0f);
    values[10] = 1;
    const std::vector<float> smooth = w.smoothed(values, 0.3f);
    EXPECT_NEAR(w.area_mean(smooth) / w.area_mean(values), 1, 0.02);  // exact if all were halved equally often
    EXPECT_GT(smooth[10], 0.7f);
    EXPECT_GT(*std::min_element(smooth.begin(), smooth.end()), 0);
    const auto centre = [&](std::uint32_t p) { return w.forest.geometry(PatchIndex(p)).point({0.5f, 0.5f}); };
    double near = 0, far = 0;
    for (std::uint32_t p = 0; p < 54; ++p) {
        if (p == 10) continue;
        double& most = (centre(p) - centre(10)).length() < 1.5f ? near : far;
        most = std::max<double>(most, smooth[p]);
    }
    EXPECT_GT(near, 5 * far);
}

}  // namespace
}  // namespace interflect
