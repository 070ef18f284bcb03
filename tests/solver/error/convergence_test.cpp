// Decay of the error with the number of rays N, and accuracy of the solver's own error estimate. Seen to fail
// (scripts/mutation-test) if streams do not advance, and with every bias listed in dense_test.cpp except those that
// need openings or two-sided faces.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "tests/support/rooms/reference_rooms.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr std::uint64_t runs = 8;

/// Root mean squares, over the seeds, of the true error and of the solver's estimate.
struct Errors {
    double error = 0, estimate = 0;
    double smallest_ratio = std::numeric_limits<double>::infinity();  // estimate / error of one run
};

class Convergence : public testing::Test {
  protected:
    const Scene scene_ = colourful_box();
    const RayCaster ray_caster_{scene_};
    const std::vector<RgbD> exact_ = dense_irradiance(scene_, exact_form_factors(scene_));

    /// Errors of each number of rays, by point set.
    std::map<std::int64_t, Errors> errors_with(PointSet points) const {
        std::map<std::int64_t, Errors> errors;
        for (const std::int64_t rays : {50'000, 200'000, 800'000, 3'200'000}) errors[rays] = errors_with(points, rays);
        return errors;
    }

    Errors errors_with(PointSet points, std::int64_t rays) const {
        Errors mean;
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
            SolveOptions options{.method = find_method("srr")};
            options.experimental.points = points;
            options.limits.rays = rays;
            options.seed = seed;
            const Solution solution = solve(scene_, ray_caster_, options);
            const double error = relative_error(scene_, solution.irradiance, exact_);
            const double estimate = solution.iterations.back().error_estimate;
            mean.error += error * error / runs;
            mean.estimate += estimate * estimate / runs;
            mean.smallest_ratio = std::min(mean.smallest_ratio, estimate / error);
        }
        mean.error = std::sqrt(mean.error);
        mean.estimate = std::sqrt(mean.estimate);
        return mean;
    }

    /// Least-squares slope of log(error) over log(N), N = 50,000 ... 3.2 million.
    static double slope(const std::map<std::int64_t, Errors>& errors) {
        double n = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (const auto& [rays, e] : errors) {
            const double log_rays = std::log(static_cast<double>(rays));
            const double log_error = std::log(e.error);
            n += 1;
            x += log_rays;
            y += log_error;
            xx += log_rays * log_rays;
            xy += log_rays * log_error;
        }
        return (n * xy - x * y) / (n * xx - x * x);
    }
};

TEST_F(Convergence, ErrorOfRandomPointsFallsAsTheRootOfTheRaysAndIsEstimated) {
    const std::map<std::int64_t, Errors> errors = errors_with(PointSet::random);
    const double s = slope(errors);
    RecordProperty("slope", std::to_string(s));
    EXPECT_LE(s, -0.45);
    EXPECT_GE(s, -0.6) << "too good to be true";
    for (const std::int64_t rays : {200'000, 800'000}) {
        const Errors& e = errors.at(rays);
        RecordProperty("ratio at " + std::to_string(rays), std::to_string(e.estimate / e.error));
        EXPECT_GT(e.estimate / e.error, 1 / 1.5) << rays;
        EXPECT_LT(e.estimate / e.error, 1.5) << rays;
    }
}

TEST_F(Convergence, ErrorOfSobolPointsFallsFasterAndIsNotUnderestimated) {
    const std::map<std::int64_t, Errors> errors = errors_with(PointSet::sobol);
    const double s = slope(errors);
    RecordProperty("slope", std::to_string(s));
    EXPECT_LE(s, -0.5);
    for (const std::int64_t rays : {50'000, 200'000, 800'000}) {
        const Errors& e = errors.at(rays);
        RecordProperty("smallest ratio at " + std::to_string(rays), std::to_string(e.smallest_ratio));
        EXPECT_GT(e.smallest_ratio, 0.8) << rays;
    }
}

}  // namespace
}  // namespace interflect
