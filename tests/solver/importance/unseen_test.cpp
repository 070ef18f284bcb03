// Where importance is small, few rays are shot and the mesh is coarse. The flat method is noisy there, the hierarchical
// one only coarse (Prikryl et al. 2000, in their maze). In the chambers below, after 300,000 rays, the errors in the
// chamber farthest from the camera are 25% (at most 215%) against 144% (1,490%). Seen to fail if Eq. 15 lacks psi.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr float length = 6, room_width = 3, room_height = 2.5f, gap = 0.6f;  // [m]
constexpr float last_chamber = 4;                                            // its lowest x [m]

/// Returns three chambers in a row, each with a lamp. Gaps at alternating ends connect them. Every rectangle is divided
/// into n x n patches.
Scene chambers(int n) {
    Scene scene = closed_box({length, room_width, room_height}, n, {{"wall", Rgb(0.6f), Rgb(0)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(100));
    const auto rectangle = [&](V3f corner, V3f u, V3f v, std::uint32_t material) {
        add_rectangle(scene, corner, u, v, material, n, n);
    };
    const V3f across(0, room_width - gap, 0), up(0, 0, room_height), thick(0.1f, 0, 0);
    for (const bool at_the_front : {false, true}) {  // the gap
        const V3f corner(at_the_front ? 4.0f : 2.0f, at_the_front ? gap : 0, 0);
        rectangle(corner, up, across, 0);
        rectangle(corner + thick, across, up, 0);
        if (at_the_front)
            rectangle(corner, thick, up, 0);
        else
            rectangle(corner + across, up, thick, 0);
    }
    for (const float x : {0.8f, 2.8f, 4.8f}) rectangle({x, 1.3f, room_height - 0.1f}, {0, 0.4f, 0}, {0.4f, 0, 0}, lamp);
    return scene;
}

const View first_chamber{"first", {1.8f, 2.8f, 1.6f}, {0.3f, 0.3f, 0.8f}, {0, 0, 1}, 60};

SolveOptions options_of(const char* method, std::int64_t rays, std::uint64_t seed) {
    SolveOptions options{.method = find_method(method)};
    options.views = {{first_chamber}};
    options.refinement.criterion = RefinementCriterion::power;
    options.experimental.epsilon_decay = 0;
    options.experimental.epsilon = 2e-6;  // used for the bounds below
    options.limits.rays = rays;
    options.seed = seed;
    return options;
}

constexpr int cells = 12;  // comparison cells in each direction on each rectangle

/// Returns the irradiance in the cells, by rectangle. Each rectangle has n x n patches in the solution.
std::vector<double> in_cells(const Solution& s, int n) {
    std::vector<double> values;
    const auto patches_each = static_cast<std::uint32_t>(n * n);
    for (PatchIndex first{0}; first < s.forest->patch_count(); first += patches_each)
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const auto centre = [](int k) { return (static_cast<float>(k) + 0.5f) / cells; };
                const ElementIndex leaf = n == cells ? first + static_cast<std::uint32_t>(j * n + i)
                                                     : s.forest->leaf_at(first, {centre(i), centre(j)});
                values.push_back(s.irradiance[leaf].x);
            }
    return values;
}

/// Errors relative to the reference.
struct PictureErrors {
    double root_mean_square = 0, largest = 0;
};

class Unseen : public testing::Test {
  protected:
    Unseen() {
        const Scene scene = chambers(cells);
        const Solution reference = solve(scene, RayCaster(scene), options_of("srr", 3'000'000, 99));
        reference_ = in_cells(reference, cells);
        for (const Patch& patch : scene.patches) {
            V3f centre(0);
            for (const std::uint32_t v : patch.vertices) centre += scene.vertices[v] / 4;
            unseen_.push_back(centre.x > last_chamber + 0.2f);
        }
    }

    PictureErrors errors(const char* method, int n) const {
        const Scene scene = chambers(n);
        const RayCaster ray_caster(scene);
        PictureErrors e;
        double terms = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const std::vector<double> values = in_cells(solve(scene, ray_caster, options_of(method, 300'000, seed)), n);
            for (std::size_t i = 0; i < values.size(); ++i) {
                if (!unseen_[i]) continue;
                const double error = std::abs(values[i] / reference_[i] - 1);
                e.root_mean_square += error * error;
                ++terms;
                e.largest = std::max(e.largest, error);
            }
        }
        e.root_mean_square = std::sqrt(e.root_mean_square / terms);
        return e;
    }

    std::vector<double> reference_;  // of the cells
    std::vector<bool> unseen_;       // whether a cell is in the last chamber
};

TEST_F(Unseen, RegionsAreCoarseWhereTheFlatMethodIsNoisy) {
    const PictureErrors hierarchical = errors("ihsrr", 1), flat = errors("isrr", cells);
    RecordProperty("error of ihsrr", std::to_string(hierarchical.root_mean_square));
    RecordProperty("largest of ihsrr", std::to_string(hierarchical.largest));
    RecordProperty("error of isrr", std::to_string(flat.root_mean_square));
    RecordProperty("largest of isrr", std::to_string(flat.largest));
    EXPECT_LT(hierarchical.root_mean_square, 0.5);
    EXPECT_LT(hierarchical.largest, 3);
    EXPECT_GT(flat.root_mean_square, 3 * hierarchical.root_mean_square);
    EXPECT_GT(flat.largest, 3 * hierarchical.largest);
}

}  // namespace
}  // namespace interflect
