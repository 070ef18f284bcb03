// One transport step, also with a mesh and an oracle that refines it: no power is lost, the result does not depend on
// the threads, and streams continue where they ended. Seen to fail (scripts/mutation-test) if a payload lacks q, rays
// are allocated uniformly, 0.5% of the power is lost, streams do not advance, or all patches share one sequence of
// points.

#include "interflect/solver/transport/transport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "interflect/elements/forest.h"
#include "interflect/solver/sampling/probabilities.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr std::int64_t rays = 50'000;

/// A scene with the state of transport steps; H = 1 everywhere. The mesh initially consists of its patches.
struct Room {
    explicit Room(Scene s, std::size_t capacity = 1 << 18) : scene(std::move(s)), forest(scene, capacity) {}

    Radiosity light() {
        irradiance.assign(forest.size(), Rgb(1));
        return Radiosity(materials, irradiance);
    }
    /// Returns a step that samples by power (Eq. 3).
    TransportStep step() {
        TransportStep step;
        step.light = light();
        step.q = mixture({materials, forest, step.light, {}, {}}, {.power = 1}).q;
        step.rays = rays;
        return step;
    }
    /// Returns a step that divides all elements down to the smallest area.
    TransportStep refining_step(float min_area) {
        TransportStep s = step();
        s.oracle.refines = true;
        s.oracle.min_area = min_area;
        return s;
    }
    Received receive(SampleStreams& streams) { return receive(streams, step()); }
    Received receive(SampleStreams& streams, const TransportStep& step) {
        return transport(materials, forest, ray_caster, step, streams);
    }
    RgbD radiated_power() { return interflect::radiated_power(forest, light()); }

    const Scene scene;
    const Materials materials{scene};
    const RayCaster ray_caster{scene};
    ElementForest forest;
    std::vector<Rgb> irradiance;
};

SampleStreams streams_of(std::uint64_t seed) { return {PointSet::sobol, seed}; }

/// Expects that all shot power is received or escapes, and that the shot power is that radiated by the room.
void expect_balance(const Room& room, const Received& received, const RgbD& radiated) {
    const RgbD arrived = integral(room.forest, received.irradiance) + received.escaped_power;
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(arrived[channel] / received.shot_power[channel], 1, 1e-6);  // irradiance is a float
        EXPECT_NEAR(received.shot_power[channel] / radiated[channel], 1, 1e-3) << "rounded ray counts";
    }
}

TEST(Transport, LosesNothing) {
    for (const Scene& scene : {colourful_box(), open_colourful_box(), furnished_room()}) {
        Room room(scene);
        SampleStreams streams = streams_of(1);
        expect_balance(room, room.receive(streams), room.radiated_power());
    }
}

TEST(Transport, LosesNothingWhileTheMeshGrowsAndAfterwards) {
    for (const Scene& scene : {colourful_box(), open_colourful_box(), furnished_room()}) {
        Room room(scene);
        SampleStreams streams = streams_of(1);
        const RgbD radiated = room.radiated_power();
        for (const float min_area : {0.05f, 0.01f, 1.0f}) {
            const std::uint32_t before = room.forest.size();
            const Received received = room.receive(streams, room.refining_step(min_area));
            EXPECT_EQ(room.forest.size() > before, min_area < 1);
            ASSERT_EQ(received.irradiance.size(), room.forest.size());
            expect_balance(room, received, radiated);
        }
        expect_balance(room, room.receive(streams), radiated);
    }
}

TEST(Transport, LosesNothingWhereTheMeshMayNotGrowAnyFurther) {
    Room room(colourful_box());
    const std::uint32_t patches = room.forest.size();
    SampleStreams streams = streams_of(1);
    const RgbD radiated = room.radiated_power();
    for (int i = 0; i < 2; ++i) {
        TransportStep step = room.refining_step(0.01f);
        step.oracle.max_elements = patches + 9;
        expect_balance(room, room.receive(streams, step), radiated);
        EXPECT_EQ(room.forest.size(), patches + 8) << "whole blocks of four";
    }
}

TEST(Transport, GivesInnerElementsTheMeanOfTheirChildren) {
    Room room(furnished_room());
    SampleStreams streams = streams_of(1);
    room.receive(streams, room.refining_step(0.1f));
    const Received received = room.receive(streams, room.refining_step(0.01f));
    std::vector<Rgb> pulled = received.irradiance;
    pull(room.forest, pulled);
    EXPECT_EQ(received.irradiance, pulled);
}

TEST(Transport, EscapesFromAnOpenBoxAlone) {
    Room closed(colourful_box()), open(open_colourful_box());
    SampleStreams closed_streams = streams_of(1), open_streams = streams_of(1);
    const Received nothing = closed.receive(closed_streams), some = open.receive(open_streams);
    EXPECT_EQ(nothing.escaped_rays, 0);
    EXPECT_EQ(nothing.escaped_power, RgbD(0, 0, 0));
    EXPECT_GT(some.escaped_rays, rays / 100);
    EXPECT_LT(some.escaped_rays, rays);
}

TEST(Transport, IsUnbiasedForAnyPositiveWeights) {
    Room room(colourful_box());
    TransportStep step = room.step();
    const std::size_t patches = step.q.size();
    for (std::size_t s = 0; s < patches; ++s) step.q[s] = 1 + static_cast<float>(s % 5);
    std::vector<std::vector<double>> arrived(patches);  // [patch][run]
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        SampleStreams streams = streams_of(seed);
        const Received received = room.receive(streams, step);
        for (std::size_t i = 0; i < patches; ++i) arrived[i].push_back(received.irradiance[i].y);
    }

    const FormFactors f = exact_form_factors(room.scene);
    std::vector<double> p_values, p_values_off;  // of the right answer, and of one that is wrong by two per cent
    for (std::size_t i = 0; i < patches; ++i) {
        double expected = 0;  // R_i / A_i = sum_s F_si P_s / A_i = sum_s F_is B_s
        for (std::uint32_t s = 0; s < patches; ++s) expected += f(i, s) * step.light.of(room.forest, ElementIndex(s)).y;
        p_values.push_back(t_test(arrived[i], expected));
        p_values_off.push_back(t_test(arrived[i], 1.02 * expected));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
    EXPECT_LT(bonferroni(p_values_off), false_alarm) << "would notice two percent";
}

TEST(Transport, CarriesImportanceWithoutBias) {
    Room room(colourful_box());
    TransportStep step = room.step();
    step.light = {};
    std::vector<float> importance;
    const std::size_t patches = step.q.size();
    for (std::size_t s = 0; s < patches; ++s) {
        importance.push_back(1 + static_cast<float>(s % 7));
        step.q[s] = 1 + static_cast<float>(s % 5);
    }
    step.importance = Importance(importance);
    std::vector<std::vector<double>> arrived(patches);  // [patch][run]
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        SampleStreams streams = streams_of(seed);
        const Received received = room.receive(streams, step);
        EXPECT_TRUE(received.irradiance.empty());
        for (std::size_t i = 0; i < patches; ++i) arrived[i].push_back(received.importance[i]);
    }

    const FormFactors f = exact_form_factors(room.scene);
    std::vector<double> p_values, p_values_off;
    for (std::size_t i = 0; i < patches; ++i) {
        double expected = 0;  // sum_s F_is rho_s psi_s: Eq. 7 without V
        for (PatchIndex s{0}; s < patches; ++s)
            expected += f(i, s) * static_cast<double>(room.materials.mean_reflectance(s) * step.importance[s]);
        p_values.push_back(t_test(arrived[i], expected));
        p_values_off.push_back(t_test(arrived[i], 1.02 * expected));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
    EXPECT_LT(bonferroni(p_values_off), false_alarm) << "would notice two percent";
}

TEST(Transport, BringsImportanceToTheLeavesWhereverPowerEnds) {
    Room room(furnished_room());
    SampleStreams streams = streams_of(1);
    room.receive(streams, room.refining_step(0.01f));
    const std::vector<float> importance(room.forest.size(), 1.0f);
    TransportStep step = room.step();
    step.importance = Importance(importance);
    SampleStreams same = streams;
    const Received at_leaves = room.receive(streams, step);
    step.oracle.refines = true;
    step.oracle.threshold = std::numeric_limits<double>::infinity();  // power ends at the patches
    const Received at_patches = room.receive(same, step);
    EXPECT_EQ(at_patches.importance, at_leaves.importance);
    EXPECT_NE(at_patches.irradiance, at_leaves.irradiance);
}

TEST(Transport, FindsTheImportanceOfASourceByTheRaysThatLeaveIt) {
    // Importance is 1 everywhere: one bounce transports rho psi, and every ray that leaves a patch gathers this value.
    Room room(closed_box({1, 2, 3}, 4, {{"wall", Rgb(0.5f), Rgb(1)}}));
    const std::vector<float> importance(room.forest.size(), 1.0f);
    TransportStep step = room.step();
    step.importance = Importance(importance);
    step.rays = 300;  // three per patch; equally many arrive
    step.q.assign(step.q.size(), 1.0f);
    step.q[7] = 200;
    SampleStreams streams = streams_of(1);
    const std::vector<float> found = room.receive(streams, step).importance;
    EXPECT_NEAR(found[7], 0.5, 0.03) << "two thirds of the rays leave it, a few arrive";
    float least = 1, most = 0;
    for (std::size_t i = 8; i < found.size(); ++i) {
        least = std::min(least, found[i]);
        most = std::max(most, found[i]);
    }
    EXPECT_LT(least, 0.3) << "one ray leaves it, or none: known from what arrives alone";
    EXPECT_GT(most, 0.7);
}

TEST(Transport, FindsNoImportanceWhereNoneIsReflected) {
    Room room(closed_box({1, 2, 3}, 2, {{"wall", Rgb(0), Rgb(1)}}));
    const std::vector<float> importance(room.forest.size(), 1.0f);
    TransportStep step = room.step();
    step.importance = Importance(importance);
    SampleStreams streams = streams_of(1);
    EXPECT_EQ(room.receive(streams, step).importance, std::vector<float>(room.forest.size(), 0.0f));
}

TEST(Transport, AdvancesTheStreamsByWhatItShot) {
    Room room(colourful_box());
    SampleStreams streams = streams_of(1);
    for (const std::int64_t steps : {1, 2, 3}) {
        room.receive(streams, room.refining_step(steps == 1 ? 1.0f : 0.01f));
        std::uint64_t used = 0;
        for (std::size_t e = 0; e < streams.used.size(); ++e) used += streams.used[e];
        EXPECT_EQ(used, static_cast<std::uint64_t>(steps * rays));
        EXPECT_EQ(streams.allocations, static_cast<std::uint64_t>(steps));
    }
}

TEST(Transport, DrawsNewRaysFromTheSameStreamsAndTheSameFromNewOnes) {
    Room room(colourful_box());
    SampleStreams streams = streams_of(1), again = streams_of(1);
    const Received first = room.receive(streams), second = room.receive(streams);
    EXPECT_NE(first.irradiance, second.irradiance);
    EXPECT_EQ(room.receive(again).irradiance, first.irradiance);
}

TEST(Transport, ShootsNothingWhereNothingRadiates) {
    Room room(colourful_box());
    TransportStep step = room.step();
    step.q.assign(step.q.size(), 0.0f);
    SampleStreams streams = streams_of(1);
    const Received received = room.receive(streams, step);
    EXPECT_EQ(received.shot_power, RgbD(0, 0, 0));
    EXPECT_EQ(received.irradiance, std::vector<Rgb>(room.forest.size(), Rgb(0)));
}

TEST(Transport, RefinesNoFurtherThanTheSmallestArea) {
    Room room(furnished_room());
    SampleStreams streams = streams_of(1);
    constexpr float min_area = 0.02f;
    room.receive(streams, room.refining_step(min_area));
    float smallest = 1;
    for (const ElementIndex e : room.forest.leaves()) smallest = std::min(smallest, room.forest.area(e));
    EXPECT_GE(smallest, min_area * (1 - 1e-6f));
    EXPECT_LT(smallest, 4 * min_area) << "everything is divided as far as it may";
}

std::uint32_t elements_under(const Rgb& exitance, float threshold) {
    Room room(closed_box({2, 1, 1}, 1, {{"wall", Rgb(0.5f), exitance}}));
    const std::vector<Rgb> darkness(room.forest.size(), Rgb(0));
    TransportStep step = room.step();
    step.light = Radiosity(room.materials, darkness);
    step.oracle.refines = true;
    step.oracle.threshold = threshold;
    step.oracle.min_area = 1e-6f;
    SampleStreams streams = streams_of(1);
    room.receive(streams, step);
    return room.forest.size();
}

TEST(Transport, RefinesByTheChannelThatBringsMost) {
    const std::uint32_t elements = elements_under(Rgb(8), 1e-3f);
    EXPECT_GT(elements, 1000u);
    EXPECT_EQ(elements_under(Rgb(8, 0, 0), 1e-3f), elements);
    EXPECT_EQ(elements_under(Rgb(0, 8, 3), 1e-3f), elements);
    EXPECT_EQ(elements_under(Rgb(1, 2, 8), 1e-3f), elements);
    EXPECT_LT(elements_under(Rgb(4), 1e-3f), elements);
    EXPECT_EQ(elements_under(Rgb(4), 0.5e-3f), elements) << "what counts is their ratio";
}

TEST(Transport, StopsRefiningWhereTheForestIsFull) {
    const Scene scene = furnished_room();
    Room room(scene, scene.patches.size() + 41);
    SampleStreams streams = streams_of(1);
    const RgbD radiated = room.radiated_power();
    const Received received = room.receive(streams, room.refining_step(1e-4f));
    EXPECT_EQ(room.forest.size(), scene.patches.size() + 40);
    expect_balance(room, received, radiated);
}

TEST(TransportRays, DrawFromASequenceOfItsOwnForEachElement) {
    Room room(colourful_box());
    SampleStreams streams = streams_of(1);
    room.receive(streams, room.refining_step(0.02f));
    TransportStep step = room.step();
    const std::int64_t rays_per_leaf = 4;
    const std::vector<ElementIndex> leaves = room.forest.leaves();
    for (const ElementIndex leaf : leaves) step.q[leaf] = 1;
    step.rays = rays_per_leaf * static_cast<std::int64_t>(leaves.size());
    const std::vector<Ray> traced = transport_rays(room.forest, room.ray_caster, step, streams_of(1));
    // The elements of the first wall are congruent: equal random numbers would give equal directions.
    for (std::size_t leaf = 1; leaf < leaves.size() && room.forest.patch(leaves[leaf]) < 9; ++leaf)
        EXPECT_GT((traced[leaf * rays_per_leaf].direction - traced[0].direction).length(), 1e-4f) << leaf;
}

TEST(TransportRays, AreThoseThatTransportTraces) {
    Room room(furnished_room());
    const TransportStep step = room.step();
    SampleStreams streams = streams_of(1);
    const std::vector<Ray> traced = transport_rays(room.forest, room.ray_caster, step, streams);
    ASSERT_EQ(traced.size(), static_cast<std::size_t>(rays));
    std::vector<Hit> hits(traced.size());
    room.ray_caster.trace(traced, hits);

    // With q proportional to the sum of the channels, every ray carries the same sum, so hits can be counted.
    std::vector<double> hit_count(room.forest.size(), 0.0);
    for (const Hit& hit : hits)
        if (hit.patch != none) ++hit_count[hit.patch];
    const double payload = channel_sum(room.radiated_power()) / static_cast<double>(rays);
    const Received received = room.receive(streams);
    for (std::uint32_t i = 0; i < hit_count.size(); ++i)
        EXPECT_NEAR(channel_sum(received.irradiance[i]) * room.forest.area(ElementIndex(i)) / payload, hit_count[i],
                    1e-5 * hit_count[i] + 1e-3);
}

}  // namespace
}  // namespace interflect
