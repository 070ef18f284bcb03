// Two sealed rooms with a lamp in one. All light in the other leaked through elements that lie on both sides of the
// wall. Cuts at contacts leave no such elements. Leaked light is a bias, not noise, so one seed suffices. The negative
// control, without cuts, leaks.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "interflect/elements/forest.h"
#include "interflect/generate.h"
#include "interflect/prepare.h"
#include "interflect/solve.h"

namespace interflect {

using namespace detail;
namespace {

constexpr float depth = 4, height = 3, thickness = 0.01f, length = 8 + thickness;  // two_rooms.cpp [m]

/// Returns the ratio of the area-weighted mean irradiance of the dark room to the lit one, over the leaves.
double leak(const TwoRoomsOptions& rooms, bool cuts, double min_area = 0) {
    const Scene whole = make_two_rooms(rooms);
    const auto min_extent = static_cast<float>(2 * default_element_size(whole));
    const Scene scene = cuts ? cut_at_contacts(whole, {.min_extent = min_extent}) : whole;
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 1'000'000;
    options.refinement.min_area = min_area;
    const Solution s = solve(scene, RayCaster(scene), options);
    const float radians = rooms.turn * std::numbers::pi_v<float> / 180;
    const V3f across(std::cos(radians), std::sin(radians), 0);
    double power[2] = {0, 0}, area[2] = {0, 0};  // lit, dark
    for (const ElementIndex e : s.forest->leaves()) {
        const PatchGeometry& patch = s.forest->geometry(s.forest->patch(e));
        const V3f x = patch.point(s.forest->cell(e).centre(patch.is_triangle()));
        const float distance = (x - V3f(length / 2, depth / 2, 0)).dot(across);  // from the middle of the wall
        const bool is_inside = x.y >= 0 && x.y <= depth && x.z >= 0 && x.z <= height;
        if (!is_inside || std::abs(distance) < 0.9f * thickness / 2) continue;  // below or behind the wall
        const int dark = distance > 0;
        power[dark] += static_cast<double>(s.irradiance[e].x) * s.forest->area(e);
        area[dark] += s.forest->area(e);
    }
    EXPECT_GT(power[0], 0);
    return power[1] / area[1] / (power[0] / area[0]);
}

struct Case {
    const char* name;
    TwoRoomsOptions rooms;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class SealedRooms : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Walls, SealedRooms,
                         testing::Values(Case{"Straight", {}}, Case{"Turned", {.turn = 30}},
                                         Case{"Furnished", {.furniture = true}},
                                         Case{"TurnedFurnished", {.turn = 30, .furniture = true}}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(SealedRooms, StayDarkWhenCutAtContacts) {
    const double found = leak(GetParam().rooms, true);
    RecordProperty("leak", std::to_string(found));
    EXPECT_LT(found, 0.001);
}

TEST_P(SealedRooms, LeakWithoutCuts) {
    // A fine mesh leaks little, because elements on both sides are small. So the mesh is kept coarse. A straight wall
    // stands at the border of elements, and hardly leaks even then.
    constexpr double min_area = 0.25;  // [m^2]
    EXPECT_GT(leak(GetParam().rooms, false), 5 * leak(GetParam().rooms, true));
    if (GetParam().rooms.turn != 0) {
        EXPECT_GT(leak(GetParam().rooms, false, min_area), 0.005) << "leaves reflect some light where they receive it";
    }
    EXPECT_LT(leak(GetParam().rooms, true, min_area), 0.001);
}

}  // namespace
}  // namespace interflect
