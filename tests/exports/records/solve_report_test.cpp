#include "interflect/exports/records/solve_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "tests/support/release_only.h"

namespace interflect {

using namespace detail;
namespace {

/// All options differ from their defaults, so a missing option is noticed.
SolveOptions unusual_options() {
    SolveOptions o{.method = find_method("ihsrr")};
    o.method.importance = ImportanceUse::direct;
    o.views = {{{"door", {0.1, 0.2, 0.3}, {1, 2, 3}, {0, 1, 0}, 60}, 2, 1.5f, 480}};
    o.limits.rays = 12345;
    o.limits.time = 2.5;
    o.limits.until = 0.02;
    o.keep_direct = true;
    o.experimental.points = PointSet::random;
    o.experimental.one_bounce = true;
    o.experimental.warm_up = 3;
    o.experimental.iterations = 4;
    o.experimental.rays_per_iteration = 500;
    o.refinement.criterion = RefinementCriterion::power;
    o.experimental.shrinkage = false;
    o.experimental.clusters = false;
    o.experimental.epsilon = 1e-3;
    o.experimental.epsilon_decay = 0.5;
    o.refinement.min_area = 1e-4;
    o.experimental.inherited_weight = 0.25;
    o.experimental.defer_refinement = o.experimental.separate_iterations = o.experimental.total_importance = true;
    o.experimental.importance_at_patches = true;
    o.importance.smoothing = 0.3;
    o.importance.exponent = 0.6;
    o.experimental.alpha = 0.2;
    o.experimental.beta = 0.4;
    o.importance.camera_rays = 99;
    return o;
}

// Fails when numbers are read unchecked: -1 became 4294967295, and 1e300 any integer.
TEST(SolveReport, RefusesOptionsOutOfRange) {
    const Json json = json_of(unusual_options());
    int numbers = 0;
    for (const auto& [name, value] : json.items()) {
        if (!value.is_number() && !value.is_boolean()) continue;
        ++numbers;
        for (const Json& absurd :
             {Json(-1), Json(-0.5), Json("7"), Json::array(), Json(std::numeric_limits<double>::infinity())}) {
            Json changed = json;
            changed[name] = absurd;
            SolveOptions options;
            EXPECT_THROW(read_options(changed, options), std::exception) << name << ": " << absurd;
        }
        if (!value.is_number_integer()) continue;
        Json changed = json;
        changed[name] = 1e300;
        SolveOptions options;
        EXPECT_THROW(read_options(changed, options), std::exception) << name;
    }
    EXPECT_GT(numbers, 20);
}

TEST(JsonText, RefusesDeepNestingAndObjectsOfManyMembers) {
    EXPECT_THROW(parse_json_text(std::string(1'000'000, '[')), std::exception);
    EXPECT_THROW(parse_json_text(std::string(500, '[') + std::string(500, ']')), std::runtime_error);
    RELEASE_ONLY();  // many members; see JsonText.KeepsNamesOfAnyBytes
    std::string object = "{";
    for (int i = 0; i < 300'000; ++i) object += "\"" + std::to_string(i) + "\": 1, ";
    EXPECT_THROW(parse_json_text(object + "\"last\": 1}"), std::runtime_error);
    std::string array = "[";
    for (int i = 0; i < 300'000; ++i) array += "{\"a\": 1}, ";
    EXPECT_EQ(parse_json_text(array + "0]").size(), 300'001u);
}

TEST(SolveReport, HasEveryOption) {
    const Json json = json_of(unusual_options()), defaults = json_of(SolveOptions());
    for (const auto& [name, value] : json.items()) EXPECT_NE(value, defaults.at(name)) << name;
    SolveOptions read{.method = find_method("ihsrr")};
    read_options(json, read);
    EXPECT_EQ(json_of(read), json);
    const SolveOptions o = unusual_options();
    EXPECT_EQ(read.limits.rays, o.limits.rays);
    EXPECT_EQ(read.limits.time, o.limits.time);
    EXPECT_EQ(read.keep_direct, o.keep_direct);
    EXPECT_EQ(read.limits.until, o.limits.until);
    EXPECT_EQ(read.experimental.points, o.experimental.points);
    EXPECT_EQ(read.experimental.one_bounce, o.experimental.one_bounce);
    EXPECT_EQ(read.experimental.warm_up, o.experimental.warm_up);
    EXPECT_EQ(read.experimental.iterations, o.experimental.iterations);
    EXPECT_EQ(read.experimental.rays_per_iteration, o.experimental.rays_per_iteration);
    EXPECT_EQ(read.refinement.criterion, o.refinement.criterion);
    EXPECT_EQ(read.experimental.shrinkage, o.experimental.shrinkage);
    EXPECT_EQ(read.experimental.clusters, o.experimental.clusters);
    EXPECT_EQ(read.experimental.epsilon, o.experimental.epsilon);
    EXPECT_EQ(read.experimental.epsilon_decay, o.experimental.epsilon_decay);
    EXPECT_EQ(read.refinement.min_area, o.refinement.min_area);
    EXPECT_EQ(read.experimental.inherited_weight, o.experimental.inherited_weight);
    EXPECT_EQ(read.experimental.defer_refinement, o.experimental.defer_refinement);
    EXPECT_EQ(read.experimental.separate_iterations, o.experimental.separate_iterations);
    EXPECT_EQ(read.experimental.importance_at_patches, o.experimental.importance_at_patches);
    EXPECT_EQ(read.experimental.total_importance, o.experimental.total_importance);
    EXPECT_EQ(read.importance.smoothing, o.importance.smoothing);
    EXPECT_EQ(read.importance.exponent, o.importance.exponent);
    EXPECT_EQ(read.experimental.alpha, o.experimental.alpha);
    EXPECT_EQ(read.experimental.beta, o.experimental.beta);
    EXPECT_EQ(read.importance.camera_rays, o.importance.camera_rays);
    EXPECT_EQ(read.method.importance, o.method.importance);
    ASSERT_EQ(read.views.size(), 1u);
    EXPECT_EQ(read.views[0].view.eye, o.views[0].view.eye);
    EXPECT_EQ(read.views[0].pixel_rows, 480);
}

TEST(SolveReport, HasNullForLimitsThatWereNotGiven) {
    SolveOptions o{.method = find_method("srr")};
    o.limits.rays = std::numeric_limits<std::int64_t>::max();
    const Json json = json_of(o);
    for (const char* limit : {"rays", "time", "until"}) EXPECT_TRUE(json.at(limit).is_null()) << limit;
    SolveOptions read = unusual_options();
    read_options(json, read);
    EXPECT_EQ(read.limits.rays, o.limits.rays);
    EXPECT_EQ(read.limits.time, o.limits.time);
    EXPECT_EQ(read.keep_direct, o.keep_direct);
    EXPECT_EQ(read.limits.until, o.limits.until);
}

TEST(SolveReport, HasTheIterationWithoutItsTime) {
    const IterationReport report{7,    1.5,  1000, 800, 200, 30,  44, 33, {1, 2, 3}, {0.1, 0.2, 0.3},
                                 0.05, 0.04, 0.03, 2.0, 1.5, 0.25};
    const Json json = json_of(report);
    EXPECT_FALSE(json.contains("seconds"));
    const IterationReport read = report_of(json);
    EXPECT_EQ(json_of(read), json);
    EXPECT_EQ(read.escaped_rays, 30);
    EXPECT_EQ(read.noise_estimate, 0.04);
    EXPECT_EQ(read.discarded_hits, 0.25);
    EXPECT_EQ(read.escaped_power, report.escaped_power);
}

TEST(SolveReport, HasNullForErrorsThatAreNotKnown) {
    const Json json = json_of(IterationReport());
    EXPECT_TRUE(json.at("noise_estimate").is_null());
    EXPECT_EQ(report_of(json).noise_estimate, std::numeric_limits<double>::infinity());
}

TEST(SolveReport, ReadsPayloadsUnderTheirFormerNames) {
    Json json = json_of(IterationReport{.largest_payload = 2.5, .high_payload = 1.5});
    json["largest_quantum"] = json.at("largest_payload");
    json["high_quantum"] = json.at("high_payload");
    json.erase("largest_payload");
    json.erase("high_payload");
    const IterationReport read = report_of(json);
    EXPECT_EQ(read.largest_payload, 2.5);
    EXPECT_EQ(read.high_payload, 1.5);
    EXPECT_EQ(with_present_columns({"rays", "high_quantum"}), (std::vector<std::string>{"rays", "high_payload"}));
}

TEST(SolveReport, ReadsOptionsUnderTheirFormerNames) {
    Json json = json_of(unusual_options());
    for (const char* name : {"time", "refinement_criterion", "one_bounce", "separate_iterations",
                             "importance_at_patches", "total_importance"})
        json.erase(name);
    json.update({{"seconds", 2.5},
                 {"refinement", "power"},
                 {"complete_passes", false},
                 {"iteration", "separate"},
                 {"importance_storage", "patch"},
                 {"importance_sampling", "total"}});
    SolveOptions read{.method = find_method("ihsrr")};
    read_options(json, read);
    EXPECT_EQ(json_of(read), json_of(unusual_options()));
    json["importance"] = "none";
    read_options(json, read);
    EXPECT_EQ(read.method.importance, ImportanceUse::off);
}

TEST(SolveReport, RefusesAnUnknownChoice) {
    Json json = json_of(SolveOptions());
    json["points"] = "halton";
    SolveOptions read{.method = find_method("srr")};
    EXPECT_ANY_THROW(read_options(json, read));
}

}  // namespace
}  // namespace interflect
