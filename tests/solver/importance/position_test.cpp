// Position, unit, rotation and order of the faces of a scene must not affect its solution. A small furnished room is
// written as MGF in many such ways, read and solved. The absorbed power and the mean of a view must equal those of the
// original room within the noise.
//
// Seen to fail with all scenes relative to the world's origin (at 100 km and beyond), and with one ray offset for the
// whole scene by its largest coordinate (the stray faces). Changes of 1% in the power or 6% in the view are noticed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/render/render_elements.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using Imath::V3d;

constexpr int placed_runs = 12;

/// Placement of the room: x -> scale * permuted(x, optionally mirrored in x) + offset.
struct Placement {
    const char* name;
    double scale = 1;
    V3d offset{0, 0, 0};
    int turn = 0;  // number of cyclic permutations of the axes
    bool mirrored = false;
    unsigned shuffle = 0;  // seed of another order of the faces; 0: original order
    const char* extra = "";

    V3d operator()(V3d x) const {
        if (mirrored) x.x = -x.x;
        return V3d(x[turn % 3], x[(turn + 1) % 3], x[(turn + 2) % 3]) * scale + offset;
    }
};

/// Returns the room as MGF: 4 x 3 x 2.5 m, with a table top, a box on the floor, a lamp under the ceiling and a picture
/// on a wall.
std::string room(const Placement& place) {
    std::vector<std::string> faces;
    const auto rectangle = [&](const char* material, V3d corner, V3d u, V3d v) {
        std::vector<V3d> corners{corner, corner + u, corner + u + v, corner + v};
        if (place.mirrored) std::reverse(corners.begin(), corners.end());  // keeps the front of a one-sided face
        std::string face = fmt::format("m {}\n", material);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const V3d x = place(corners[i]);
            face += fmt::format("v v{} =\n\tp {} {} {}\n", i, x.x, x.y, x.z);
        }
        faces.push_back(face + "f v0 v1 v2 v3\n");
    };
    const auto box = [&](const char* material, V3d low, V3d s) {
        const V3d x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        rectangle(material, low, y, x);
        rectangle(material, low + z, x, y);
        rectangle(material, low, x, z);
        rectangle(material, low + y, z, x);
        rectangle(material, low, z, y);
        rectangle(material, low + x, y, z);
    };
    box("paint", {0, 0, 0}, {4, 3, 2.5});
    box("wood", {0.5, 0.6, 0}, {0.8, 0.5, 0.9});
    rectangle("wood", {2, 1, 0.74}, {1.4, 0, 0}, {0, 0.8, 0});
    rectangle("picture", {4, 1, 1.2}, {0, 0, 0.5}, {0, 0.7, 0});
    rectangle("lamp", {1.5, 1.2, 2.4}, {0, 0.6, 0}, {0.9, 0, 0});
    if (place.shuffle > 0) std::shuffle(faces.begin(), faces.end(), std::mt19937(place.shuffle));
    std::string text = "m paint =\n\trd .6\nm wood =\n\trd .3\nm picture =\n\trd .8\nm lamp =\n\tsides 1\n\ted 1000\n";
    for (const std::string& face : faces) text += face;
    return text + place.extra;
}

/// Results of a solution that do not depend on the unit of length.
struct Measured {
    double absorbed = 0;  // relative to the emitted power
    double seen = 0;      // mean luminance of a view [cd/m^2]
};

Measured measure(const Placement& place, std::uint64_t seed) {
    const Scene scene = read_mgf_text(room(place), "room.mgf");
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 150'000;
    options.seed = seed;
    const Solution solution = solve(scene, ray_caster, options);
    const Materials materials(scene, ray_caster);
    Measured result;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        result.absorbed += static_cast<double>((1 - materials.reflectance(i).x) * solution.irradiance[i].x *
                                               solution.forest->area(i)) /
                           solution.emitted_power.x;
    View view{"room", place({0.2, 0.2, 1.6}), place({3, 2.5, 0.8}), V3f(place({0, 0, 1}) - place({0, 0, 0})), 70};
    const Image image = render(scene, *solution.forest, ray_caster, view, solution.irradiance,
                               {.width = 32, .height = 24, .shading = Shading::flat, .samples = 4, .seed = seed})
                            .image;
    for (const Rgb& pixel : image.pixels)
        result.seen += static_cast<double>(pixel.x) / static_cast<double>(image.pixels.size());
    return result;
}

/// Relative change of each quantity by the placement, per seed.
struct Changes {
    std::vector<double> absorbed, seen;
};

Changes changes(const Placement& place, const std::vector<Measured>& reference) {
    Changes result;
    for (std::uint64_t seed = 1; seed <= placed_runs; ++seed) {
        const Measured m = measure(place, seed), &r = reference[seed - 1];
        result.absorbed.push_back(m.absorbed / r.absorbed - 1);
        result.seen.push_back(m.seen / r.seen - 1);
    }
    return result;
}

std::vector<double> plus(std::vector<double> values, double more) {
    for (double& v : values) v += more;
    return values;
}

constexpr const char* stray_sliver = "v a =\n\tp 1e5 0 0\nv b =\n\tp 1e5 0 0\nv c =\n\tp 2e5 0 0\nm paint\nf a b c\n";
constexpr const char* stray_face = "v a =\n\tp 1e5 0 0\nv b =\n\tp 100001 0 0\nv c =\n\tp 1e5 1 0\nm paint\nf a b c\n";
constexpr const char* unused_vertex = "v a =\n\tp 1e9 0 0\n";

const std::vector<Placement> placements = {
    {.name = "Again"},
    {.name = "At1km", .offset = {1000, -1000, 0}},
    {.name = "At10km", .offset = {0, 1e4, 0}},
    {.name = "At100km", .offset = {1e5, 1e5, -1e5}},
    {.name = "At10000km", .offset = {1e7, 0, 0}},
    {.name = "InMillimetres", .scale = 1000},
    {.name = "InKilometres", .scale = 1e-3},
    {.name = "InKilometresFarAway", .scale = 1e-3, .offset = {30, 0, 50}},
    {.name = "Mirrored", .mirrored = true},
    {.name = "AxesPermuted", .turn = 1},
    {.name = "AxesPermutedAt1km", .offset = {0, 1000, 0}, .turn = 2},
    {.name = "Shuffled", .shuffle = 1},
    {.name = "ShuffledMirroredAt3km", .offset = {3000.3, 0.1, -77.7}, .mirrored = true, .shuffle = 2},
    {.name = "WithAStraySliver", .extra = stray_sliver},
    {.name = "WithAStrayFace", .extra = stray_face},
    {.name = "WithAnUnusedVertex", .extra = unused_vertex},
};

/// One test of all placements, because they have the runs of the original room in common.
TEST(Position, DoesNotMatter) {
    std::vector<Measured> reference;
    for (std::uint64_t seed = 1; seed <= placed_runs; ++seed) reference.push_back(measure({"as it is"}, 1000 + seed));
    // Probability of a false alarm per placement and quantity; false_alarm for all together.
    const double chance = false_alarm / static_cast<double>(2 * placements.size());
    for (const Placement& place : placements) {
        SCOPED_TRACE(place.name);
        const Changes c = changes(place, reference);
        EXPECT_GT(t_test(c.absorbed, 0), chance);
        EXPECT_GT(t_test(c.seen, 0), chance);
        EXPECT_LT(t_test(plus(c.absorbed, 0.01), 0), chance) << "1% more light would be noticed";
        EXPECT_LT(t_test(plus(c.seen, 0.06), 0), chance) << "6% more light in the view would be noticed";
        EXPECT_NEAR(std::accumulate(c.absorbed.begin(), c.absorbed.end(), 0.0) / placed_runs, 0, 0.003);
    }
}

TEST(Position, IsKeptAsTheOriginOfTheScene) {
    const Scene near = read_mgf_text(room({"near"}), "room.mgf");
    const Scene far = read_mgf_text(room({.name = "far", .offset = {1e5, 0, 0}}), "room.mgf");
    EXPECT_EQ(near.origin, V3d(0));
    ASSERT_EQ(near.vertices.size(), far.vertices.size());
    for (std::size_t i = 0; i < near.vertices.size(); ++i) {
        const V3d x = far.origin + V3d(far.vertices[i]), expected = V3d(near.vertices[i]) + V3d(1e5, 0, 0);
        EXPECT_LT((x - expected).length(), 1e-6) << i;
    }
}

std::string refusal(const std::string& text) {
    try {
        read_mgf_text(text, "room.mgf");
    } catch (const InputError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(Position, ThatCannotBeRepresentedIsRefused) {
    const auto far_face = [](const char* x) {
        return room({"room"}) +
               fmt::format("v a =\n\tp {0} 0 0\nv b =\n\tp {0} 1 0\nv c =\n\tp {0} 0 1\nm paint\nf a b c\n", x);
    };
    EXPECT_NE(refusal(far_face("1e9")).find("is lost to rounding: it is 1e+09 m from the middle"), std::string::npos)
        << refusal(far_face("1e9"));
    EXPECT_NE(refusal(far_face("1e16")).find("farther than 1e+15 m"), std::string::npos) << refusal(far_face("1e16"));
    EXPECT_EQ(refusal(far_face("1e5")), "not refused");
    EXPECT_EQ(refusal(room({.name = "far", .offset = {1e9, 0, 0}})), "not refused");
}

}  // namespace
}  // namespace interflect
