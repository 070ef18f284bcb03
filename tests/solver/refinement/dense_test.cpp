// Eq. 1 (Prikryl et al. 2000) as a dense linear system, per patch and channel. Its solution must be the solver's mean
// over many seeds. In an empty box the form factors are exact. In a furnished room an independent ray tracer computes
// them, and its noise enters the test.
//
// Seen to fail (scripts/mutation-test) if radiosity lacks rho, irradiance or power lacks the area, a payload lacks q,
// rays are allocated uniformly, 0.5% of the power is lost, directions lack the cosine or cover an azimuth of only 6
// radians, origins cluster near the centre, escaped rays hit a patch, backs of faces act as fronts, or rays start
// without an offset from their surface.

#include <gtest/gtest.h>

#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/brute_force.h"
#include "tests/support/parameter_names.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Irradiance of every leaf and channel in solutions with different seeds on one mesh.
class Sample {
  public:
    template <class OptionsOfSeed>
    Sample(const Scene& scene, std::uint64_t runs, const OptionsOfSeed& options_of_seed) {
        const RayCaster ray_caster(scene);
        for (std::uint64_t seed = 1; seed <= runs; ++seed) add(solve(scene, ray_caster, options_of_seed(seed)));
    }
    Sample(const Scene& scene, PointSet points)
        : Sample(scene, 32, [&](std::uint64_t seed) { return unbiased_options(points, seed); }) {}

    /// Returns the p-value of the hypothesis that the expected values are `factor` times `irradiance`, which has the
    /// standard error `error`.
    double p_value(double factor, const std::vector<RgbD>& irradiance, const std::vector<RgbD>& error) const {
        std::vector<double> p_values;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const int channel = static_cast<int>(i % 3);
            p_values.push_back(t_test(values_[i], factor * irradiance[i / 3][channel], error[i / 3][channel]));
        }
        return bonferroni(p_values);
    }
    /// The same for an exact `irradiance`.
    double p_value(double factor, const std::vector<RgbD>& irradiance) const {
        return p_value(factor, irradiance, std::vector<RgbD>(irradiance.size(), RgbD(0, 0, 0)));
    }

    const std::vector<Solution>& solutions() const { return solutions_; }

  private:
    void add(Solution solution) {
        const std::vector<ElementIndex> leaves = leaves_by_place(*solution.forest);
        values_.resize(3 * leaves.size());
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i].push_back(solution.irradiance.at(leaves.at(i / 3))[static_cast<int>(i % 3)]);
        solutions_.push_back(std::move(solution));
    }

    std::vector<std::vector<double>> values_;  // [leaf and channel][run]
    std::vector<Solution> solutions_;
};

class DenseSolution : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(Points, DenseSolution, testing::Values(PointSet::sobol, PointSet::random),
                         testing::PrintToStringParamName());

TEST_P(DenseSolution, IsTheMeanInAColourfulBox) {
    const Scene scene = colourful_box();
    const std::vector<RgbD> exact = dense_irradiance(scene, exact_form_factors(scene));
    const Sample sample(scene, GetParam());
    EXPECT_GT(sample.p_value(1, exact), false_alarm);
    EXPECT_LT(sample.p_value(1.01, exact), false_alarm) << "would notice one percent";
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
    const FormFactors f = exact_form_factors(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, f);
    RgbD escaping(0, 0, 0);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Material& material = scene.materials[scene.patches[i].material];
        const RgbD radiosity = RgbD(material.exitance) + RgbD(material.reflectance) * exact[i];
        escaping += radiosity * (patch_area(scene, scene.patches[i]) * (1 - f.row_sum(i)));
    }

    const Sample sample(scene, GetParam());
    EXPECT_GT(sample.p_value(1, exact), false_alarm);
    EXPECT_LT(sample.p_value(1.01, exact), false_alarm) << "would notice one percent";

    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> escaped;
        for (const Solution& s : sample.solutions()) escaped.push_back(s.iterations.back().escaped_power[channel]);
        EXPECT_GT(3 * t_test(escaped, escaping[channel]), false_alarm);
        EXPECT_LT(3 * t_test(escaped, 1.03 * escaping[channel]), false_alarm) << "would notice three percent";
    }
}

// Variants of passes and of kept rays on a mesh that is divided once and then fixed: payloads differ, and receivers are
// found from the root. The leaves are converted to a scene, whose dense solution is exact.
class DenseSolutionOfMethod : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(All, DenseSolutionOfMethod, testing::ValuesIn(stochastic_variants()),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(KeptRays, DenseSolutionOfMethod, testing::ValuesIn(variants_that_keep_every_ray()),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Extremes, DenseSolutionOfMethod, testing::ValuesIn(extreme_variants()),
                         [](const auto& test) { return test.param.name; });

TEST_P(DenseSolutionOfMethod, IsTheMeanInAColourfulBox) {
    Scene scene = colourful_box();
    scene.materials[3].reflectance = Rgb(0.02f);  // a black element would receive as a whole on any mesh
    const Sample sample(scene, 20, [](std::uint64_t seed) { return on_a_fixed_mesh(GetParam(), seed); });
    const bool divided = GetParam().options.method.refines && !GetParam().options.experimental.defer_refinement;
    for (const Solution& s : sample.solutions()) ASSERT_EQ(s.forest->size(), divided ? 5u * 54 : 54u);
    const Scene leaves = scene_of_leaves(scene, *sample.solutions()[0].forest);
    const std::vector<RgbD> exact = dense_irradiance(leaves, exact_form_factors(leaves));
    EXPECT_GT(sample.p_value(1, exact), false_alarm);
    EXPECT_LT(sample.p_value(1.04, exact), false_alarm) << "would notice four percent";
}

}  // namespace
}  // namespace interflect
