#include "interflect/exports/solve_report.h"

#include <gtest/gtest.h>

#include <limits>

namespace interflect {
namespace {

/// No option has its default, so that none can be forgotten.
SolveOptions unusual_options() {
    SolveOptions o{.method = find_method("srr")};
    o.method = find_method("ihsrr");
    o.method.importance = ImportanceUse::direct;
    o.views = {{{"door", {0.1, 0.2, 0.3}, {1, 2, 3}, {0, 1, 0}, 60}, 2, 1.5f, 480}};
    o.rays = 12345;
    o.seconds = 2.5;
    o.until = 0.02;
    o.points = PointSet::random;
    o.complete_passes = false;
    o.warm_up = 3;
    o.iterations = 4;
    o.rays_per_iteration = 500;
    o.refinement = Refinement::power;
    o.shrinkage = false;
    o.epsilon = 1e-3;
    o.epsilon_decay = 0.5;
    o.min_area = 1e-4;
    o.inherited_weight = 0.25;
    o.defer_refinement = o.separate_iterations = o.total_importance = true;
    o.importance_at_elements = false;
    o.importance_smoothing = 0.3;
    o.importance_exponent = 0.6;
    o.alpha = 0.2;
    o.beta = 0.4;
    o.camera_rays = 99;
    return o;
}

TEST(SolveReport, HasEveryOption) {
    const Json json = json_of(unusual_options()), defaults = json_of(SolveOptions());
    for (const auto& [name, value] : json.items()) EXPECT_NE(value, defaults.at(name)) << name;
    SolveOptions read{.method = find_method("srr")};
    read.method = find_method("ihsrr");
    read_options(json, read);
    EXPECT_EQ(json_of(read), json);
    const SolveOptions o = unusual_options();
    EXPECT_EQ(read.rays, o.rays);
    EXPECT_EQ(read.seconds, o.seconds);
    EXPECT_EQ(read.until, o.until);
    EXPECT_EQ(read.points, o.points);
    EXPECT_EQ(read.complete_passes, o.complete_passes);
    EXPECT_EQ(read.warm_up, o.warm_up);
    EXPECT_EQ(read.iterations, o.iterations);
    EXPECT_EQ(read.rays_per_iteration, o.rays_per_iteration);
    EXPECT_EQ(read.refinement, o.refinement);
    EXPECT_EQ(read.shrinkage, o.shrinkage);
    EXPECT_EQ(read.epsilon, o.epsilon);
    EXPECT_EQ(read.epsilon_decay, o.epsilon_decay);
    EXPECT_EQ(read.min_area, o.min_area);
    EXPECT_EQ(read.inherited_weight, o.inherited_weight);
    EXPECT_EQ(read.defer_refinement, o.defer_refinement);
    EXPECT_EQ(read.separate_iterations, o.separate_iterations);
    EXPECT_EQ(read.importance_at_elements, o.importance_at_elements);
    EXPECT_EQ(read.total_importance, o.total_importance);
    EXPECT_EQ(read.importance_smoothing, o.importance_smoothing);
    EXPECT_EQ(read.importance_exponent, o.importance_exponent);
    EXPECT_EQ(read.alpha, o.alpha);
    EXPECT_EQ(read.beta, o.beta);
    EXPECT_EQ(read.camera_rays, o.camera_rays);
    EXPECT_EQ(read.method.importance, o.method.importance);
    ASSERT_EQ(read.views.size(), 1u);
    EXPECT_EQ(read.views[0].view.eye, o.views[0].view.eye);
    EXPECT_EQ(read.views[0].pixel_rows, 480);
}

TEST(SolveReport, HasNullForLimitsThatWereNotGiven) {
    SolveOptions o{.method = find_method("srr")};
    o.rays = std::numeric_limits<std::int64_t>::max();
    const Json json = json_of(o);
    for (const char* limit : {"rays", "seconds", "until"}) EXPECT_TRUE(json.at(limit).is_null()) << limit;
    SolveOptions read = unusual_options();
    read_options(json, read);
    EXPECT_EQ(read.rays, o.rays);
    EXPECT_EQ(read.seconds, o.seconds);
    EXPECT_EQ(read.until, o.until);
}

TEST(SolveReport, HasTheIterationWithoutItsTime) {
    const IterationReport report{7,    1.5,  1000, 800, 200, 30, 44, 33, {1, 2, 3}, {0.1, 0.2, 0.3},
                                 0.05, 0.04, 0.03, 2.0, 1.5};
    const Json json = json_of(report);
    EXPECT_FALSE(json.contains("seconds"));
    const IterationReport read = report_of(json);
    EXPECT_EQ(json_of(read), json);
    EXPECT_EQ(read.escaped_rays, 30);
    EXPECT_EQ(read.noise_estimate, 0.04);
    EXPECT_EQ(read.escaped_power, report.escaped_power);
}

TEST(SolveReport, HasNullForErrorsThatAreNotKnown) {
    const Json json = json_of(IterationReport());
    EXPECT_TRUE(json.at("noise_estimate").is_null());
    EXPECT_EQ(report_of(json).noise_estimate, std::numeric_limits<double>::infinity());
}

TEST(SolveReport, RefusesAnUnknownChoice) {
    Json json = json_of(SolveOptions());
    json["points"] = "halton";
    SolveOptions read{.method = find_method("srr")};
    EXPECT_ANY_THROW(read_options(json, read));
}

}  // namespace
}  // namespace interflect
