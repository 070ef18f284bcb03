// Eq. 1 (Prikryl et al. 2000) as a dense linear system, patch by patch and channel by channel: the solver's mean over
// many seeds must be its solution. In an empty box the form factors are exact; in a furnished room they come from an
// independent ray tracer, whose own noise enters the test.
//
// Seen to fail (scripts/plant-faults) when radiosity lacks rho, irradiance or power lacks the area, a quantum lacks q,
// rays are allocated uniformly, 0.5% of the power is lost, directions lack the cosine or turn over 6 radians, origins
// crowd near the centre, escaped rays land on a patch, backs of faces answer as their fronts, rays are not lifted off
// their surface.

#include <gtest/gtest.h>

#include "interflect/solver/surfaces.h"
#include "tests/solver/reference_rooms.h"
#include "tests/support/brute_force.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr std::uint64_t runs = 32;

/// Irradiance of every patch and channel in solutions with different seeds.
class Sample {
  public:
    Sample(const Scene& scene, PointSet points) : values_(3 * scene.patches.size()) {
        const RayCaster ray_caster(scene);
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
            solutions_.push_back(solve(scene, ray_caster, unbiased_options(points, seed)));
            for (std::size_t i = 0; i < values_.size(); ++i)
                values_[i].push_back(solutions_.back().irradiance[i / 3][static_cast<int>(i % 3)]);
        }
    }

    /// p-value of the hypothesis that the expected values are `factor` times `irradiance`, itself known to `error`.
    double p_value(double factor, const std::vector<RgbD>& irradiance, const std::vector<RgbD>& error) const {
        std::vector<double> p_values;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const int channel = static_cast<int>(i % 3);
            p_values.push_back(t_test(values_[i], factor * irradiance[i / 3][channel], error[i / 3][channel]));
        }
        return bonferroni(p_values);
    }

    const std::vector<Solution>& solutions() const { return solutions_; }

  private:
    std::vector<std::vector<double>> values_;  // [patch and channel][run]
    std::vector<Solution> solutions_;
};

class DenseSolution : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(Points, DenseSolution, testing::Values(PointSet::sobol, PointSet::random),
                         [](const auto& test) { return test.param == PointSet::sobol ? "sobol" : "random"; });

TEST_P(DenseSolution, IsTheMeanInAColourfulBox) {
    const Scene scene = colourful_box();
    const std::vector<RgbD> exact = dense_irradiance(scene, exact_form_factors(scene));
    const std::vector<RgbD> no_error(exact.size(), RgbD(0, 0, 0));
    const Sample sample(scene, GetParam());
    EXPECT_GT(sample.p_value(1, exact, no_error), false_alarm);
    EXPECT_LT(sample.p_value(1.01, exact, no_error), false_alarm) << "would notice one percent";
}

TEST_P(DenseSolution, IsTheMeanInAFurnishedRoom) {
    constexpr std::int64_t rays_per_patch = 50'000;
    const Scene scene = furnished_room();
    const FormFactors f = traced_form_factors(scene, rays_per_patch, 1);
    const std::vector<RgbD> reference = dense_irradiance(scene, f);
    const std::vector<RgbD> error = dense_irradiance_error(scene, f, rays_per_patch);
    const Sample sample(scene, GetParam());
    EXPECT_GT(sample.p_value(1, reference, error), false_alarm);
    EXPECT_LT(sample.p_value(1.02, reference, error), false_alarm) << "would notice two percent";
}

TEST_P(DenseSolution, IsTheMeanInAnOpenBoxAndWhatEscapesIsCounted) {
    const Scene scene = open_colourful_box();
    const Surfaces surfaces(scene);
    const FormFactors f = exact_form_factors(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, f);
    RgbD escaping(0, 0, 0);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const RgbD radiosity = RgbD(surfaces.exitance(i)) + RgbD(surfaces.reflectance(i)) * exact[i];
        escaping += radiosity * (surfaces.area(i) * (1 - f.row_sum(i)));
    }

    const std::vector<RgbD> no_error(exact.size(), RgbD(0, 0, 0));
    const Sample sample(scene, GetParam());
    EXPECT_GT(sample.p_value(1, exact, no_error), false_alarm);
    EXPECT_LT(sample.p_value(1.01, exact, no_error), false_alarm) << "would notice one percent";

    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> escaped;
        for (const Solution& s : sample.solutions()) escaped.push_back(s.iterations.back().escaped_power[channel]);
        EXPECT_GT(3 * t_test(escaped, escaping[channel]), false_alarm);
        EXPECT_LT(3 * t_test(escaped, 1.02 * escaping[channel]), false_alarm) << "would notice two percent";
    }
}

}  // namespace
}  // namespace interflect
