// Links of clusters in `hr`, against links of all pairs of patches, which tests/solver/methods/link_radiosity_test.cpp
// compares with closed forms. Deterministic: the tolerances are about twice the observed differences.
//
// Seen to fail if members lack their area, the scale lacks 1/pi, a divided pair lacks a child, the parts of a cluster
// are not linked, lines of sight are not traced, light flows in one direction only, the variation of equal lines is 0,
// or importance lacks rho.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/light/radiosity.h"
#include "interflect/solver/methods/links/cluster_exchange.h"
#include "interflect/solver/methods/links/first_links.h"
#include "interflect/solver/methods/links/link_radiosity.h"
#include "interflect/solver/methods/links/patch_tree.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

class RandomTriangles {
  public:
    /// Adds two-sided triangles with corners within `size` of random points of the box.
    void add(Scene& scene, int count, const V3f& low, const V3f& high, float size, std::uint32_t material) {
        if (scene.objects.empty()) scene.objects.emplace_back();
        for (int i = 0; i < count; ++i) {
            const auto vertex = static_cast<std::uint32_t>(scene.vertices.size());
            const PatchIndex patch(scene.patches.size());
            const V3f middle = low + (high - low) * uniform();
            for (int k = 0; k < 3; ++k) scene.vertices.push_back(middle + (uniform() * 2.0f - V3f(1)) * size);
            Patch front, back;
            front.vertices = {vertex, vertex + 1, vertex + 2, none};
            back.vertices = {vertex, vertex + 2, vertex + 1, none};
            front.material = back.material = material;
            front.other_side = patch + 1;
            back.other_side = patch;
            scene.patches.push_back(front);
            scene.patches.push_back(back);
        }
    }

  private:
    V3f uniform() {
        const auto one = [&] { return static_cast<float>(random_() >> 8) * 0x1p-24f; };
        const float x = one(), y = one(), z = one();
        return {x, y, z};
    }

    std::mt19937 random_{1};
};

/// Returns a room of 4 x 3 x 2.5 m with walls of 0.5 m^2, a lamp of one square metre and loose triangles.
Scene soup(int triangles, float size, const Rgb& walls = {0.7f, 0.6f, 0.5f}) {
    Scene scene = closed_box({4, 3, 2.5f}, 4, {{"wall", walls, Rgb(0)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(50)), leaf = add_material(scene, Rgb(0.6f), Rgb(0));
    add_rectangle(scene, {1.5f, 1, 2.45f}, {0, 1, 0}, {1, 0, 0}, lamp);
    RandomTriangles().add(scene, triangles, {0.2f, 0.2f, 0.2f}, {3.8f, 2.8f, 2.2f}, size, leaf);
    return scene;
}

SolveOptions unrefined(bool clusters) {
    SolveOptions options{.method = find_method("hr")};
    options.method.importance = ImportanceUse::off;
    options.method.refines = false;
    options.experimental.epsilon = 1e-3;
    options.experimental.clusters = clusters;
    options.limits.rays = 100'000;  // too few for all pairs
    return options;
}

Solution solve_scene(const Scene& scene, const SolveOptions& options) {
    return solve(scene, RayCaster(scene), options);
}

double power(const Solution& s, const std::vector<Rgb>& irradiance) {
    double sum = 0;
    for (PatchIndex p{0}; p < s.forest->patch_count(); ++p)
        sum += static_cast<double>(s.forest->area(p) * luminance(irradiance[p]));
    return sum;
}

/// Root mean square difference of the patches' irradiance, relative to the mean.
double difference(const Solution& a, const Solution& b) {
    double squares = 0, area = 0;
    for (PatchIndex p{0}; p < a.forest->patch_count(); ++p) {
        const double d = luminance(a.irradiance[p]) - luminance(b.irradiance[p]);
        squares += static_cast<double>(a.forest->area(p)) * d * d;
        area += static_cast<double>(a.forest->area(p));
    }
    return std::sqrt(squares / area) / (power(b, b.irradiance) / area);
}

// The tree.

TEST(PatchTree, IsBinaryAndContainsEveryPatchOnce) {
    const Scene scene = soup(100, 0.1f);
    const ElementForest forest(scene, scene.patches.size());
    std::vector<PatchIndex> patches;
    for (PatchIndex p{3}; p < forest.patch_count(); ++p) patches.push_back(p);
    const PatchTree tree(forest, patches);
    ASSERT_EQ(tree.clusters().size(), patches.size() - 1);
    std::multiset<ElementIndex> found;
    for (std::uint32_t i = 0; i < tree.clusters().size(); ++i) {
        const PatchTree::Cluster& cluster = tree.clusters()[i];
        std::size_t below = 0;
        for (const ElementIndex child : cluster.children) {
            below += is_cluster(child) ? tree.members(child).size() : 1;
            if (is_cluster(child))
                EXPECT_GT(child, first_cluster + i) << "parents come first";
            else
                found.insert(child);
        }
        const std::span<const ClusterMember> members = tree.members(ElementIndex(first_cluster + i));
        EXPECT_EQ(below, members.size());
        double area = 0;
        for (const ClusterMember& member : members) {
            area += static_cast<double>(forest.area(member.element));
            EXPECT_NEAR(member.area_vector.length() / forest.area(member.element), 1, 1e-5);
            const Patch& patch = scene.patches[forest.patch(member.element)];
            for (const std::uint32_t v :
                 std::span(patch.vertices).first(static_cast<std::size_t>(patch.vertex_count())))
                EXPECT_LE((scene.vertices[v] - cluster.sphere.centre).length(), cluster.sphere.radius + 1e-5f);
        }
        EXPECT_NEAR(cluster.area / area, 1, 1e-5);
    }
    EXPECT_TRUE(std::equal(found.begin(), found.end(), patches.begin(), patches.end()));
}

// Exchange of two clusters.

/// A scene with two groups of 40 triangles: in a cube of 0.4 m at the origin, and around (distance, 0, 0).
struct TwoGroups {
    Scene scene;
    ElementForest forest;
    PatchTree tree;
    RayCaster ray_caster;
    ExchangeEstimator patches;
    ClusterExchange clusters;

    static Scene make(float distance, bool has_board) {
        Scene scene;
        const std::uint32_t grey = add_material(scene, Rgb(0.5f), Rgb(0));
        RandomTriangles random;
        random.add(scene, 40, V3f(0), V3f(0.4f), 0.03f, grey);
        random.add(scene, 40, {distance, 0, 0}, {distance + 0.4f, 0.4f, 0.4f}, 0.03f, grey);
        add_rectangle(scene, {distance / 2 + 0.2f, -9, -9}, {0, has_board ? 18.0f : 0.01f, 0}, {0, 0, 18}, grey, 1, 1,
                      true);
        return scene;
    }
    static std::vector<PatchIndex> all_but_board(const Scene& scene) {
        std::vector<PatchIndex> patches;
        for (PatchIndex p{0}; p + 2 < scene.patches.size(); ++p) patches.push_back(p);
        return patches;
    }

    explicit TwoGroups(float distance, bool has_board = false)
        : scene(make(distance, has_board)),
          forest(scene, scene.patches.size()),
          tree(forest, all_but_board(scene)),
          ray_caster(scene),
          patches(scene, forest, ray_caster, 1),
          clusters(forest, tree, patches, 1) {}

    /// The first division separates the groups.
    ElementPair groups() const { return {tree.clusters()[0].children[0], tree.clusters()[0].children[1]}; }

    /// Returns the power that each patch receives if all have a radiosity of 1.
    std::vector<double> received(const ElementPair& pair) const {
        std::vector<double> all(forest.size(), 0);
        const std::vector<double> bright(forest.size(), 1);
        clusters.transport(pair, 1.0, bright, all);
        return all;
    }
    /// The same by pairs of patches.
    std::vector<double> received_by_pairs(std::span<const ClusterMember> a, std::span<const ClusterMember> b) const {
        std::vector<double> all(forest.size(), 0);
        std::int64_t rays = 0;
        for (const ClusterMember& p : a)
            for (const ClusterMember& q : b) {
                const auto area =
                    static_cast<double>(patches.estimate({p.element, q.element}, Effort::thorough, rays).area);
                all[p.element] += area;
                all[q.element] += area;
            }
        return all;
    }
};

double sum(const std::vector<double>& values) {
    double all = 0;
    for (const double v : values) all += v;
    return all;
}
double relative_rms(const std::vector<double>& values, const std::vector<double>& expected) {
    double squares = 0, all = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        squares += (values[i] - expected[i]) * (values[i] - expected[i]);
        all += expected[i] * expected[i];
    }
    return std::sqrt(squares / all);
}

TEST(ClusterExchange, OfDistantGroupsIsTheSumOverPairs) {
    for (const auto& [distance, tolerance] : {std::pair{1.2f, 0.05}, {2.4f, 0.025}, {4.8f, 0.0125}}) {
        const TwoGroups scene(distance);
        const auto [a, b] = scene.groups();
        ASSERT_TRUE(is_cluster(a) && is_cluster(b) && scene.clusters.is_valid({a, b}));
        const std::vector<double> expected = scene.received_by_pairs(scene.tree.members(a), scene.tree.members(b));
        EXPECT_NEAR(sum(scene.received({a, b})) / sum(expected), 1, 0.6 * tolerance) << distance;
        EXPECT_LT(relative_rms(scene.received({a, b}), expected), tolerance) << distance;
        std::int64_t rays = 0;
        const Exchange exchange = scene.clusters.estimate({a, b}, Effort::quick, rays);
        EXPECT_NEAR(2 * exchange.area / sum(expected), 1, 0.6 * tolerance);
    }
}

TEST(ClusterExchange, OfAGroupAndANearWallIsTheSumOverPatches) {
    const TwoGroups scene(1.2f, true);
    const auto [first, second] = scene.groups();
    for (const ElementIndex group : {first, second})
        for (const std::uint32_t side : {0u, 1u}) {
            const PatchIndex wall(scene.scene.patches.size() - 2 + side);
            ASSERT_TRUE(scene.clusters.is_valid({wall, group}));
            const ClusterMember member = member_of(scene.forest, wall);
            const std::vector<double> expected =
                scene.received_by_pairs(std::span(&member, 1), scene.tree.members(group));
            if (sum(expected) == 0) {
                EXPECT_EQ(sum(scene.received({wall, group})), 0) << "behind the wall";
                continue;
            }
            EXPECT_LT(relative_rms(scene.received({wall, group}), expected), 1e-5);
        }
}

TEST(ClusterExchange, DoesNotPassABoard) {
    for (const bool has_board : {false, true}) {
        const TwoGroups scene(1.2f, has_board);
        std::int64_t rays = 0;
        const Exchange exchange = scene.clusters.estimate(scene.groups(), Effort::thorough, rays);
        EXPECT_GT(exchange.area, 0);
        if (has_board)
            EXPECT_EQ(exchange.transmittance, Rgb(0));
        else
            EXPECT_GT(exchange.transmittance.x, 0.4f);
        EXPECT_GT(exchange.variation, 0) << "16 lines may agree by chance";
    }
}

TEST(ClusterExchange, IsNotUsedBetweenNearGroups) {
    const TwoGroups scene(0.4f);
    EXPECT_FALSE(scene.clusters.is_valid(scene.groups()));
}

// Light.

void solve_with_links(const Scene& scene, const SolveOptions& options, std::size_t link_limit) {
    const RayCaster ray_caster(scene);
    SolverState state(scene, ray_caster, options);
    LinkedElements(state, link_limit).prepare(state);
}

TEST(ClusterLinks, AreFewAndGiveTheLightOfAllPairs) {
    const Scene scene = soup(400, 0.1f);
    const Solution by_pairs = solve_scene(scene, unrefined(false)), by_clusters = solve_scene(scene, unrefined(true));
    EXPECT_NEAR(power(by_clusters, by_clusters.irradiance) / power(by_pairs, by_pairs.irradiance), 1, 0.02);
    EXPECT_LT(difference(by_clusters, by_pairs), 0.05);
    EXPECT_NO_THROW(solve_with_links(scene, unrefined(true), 20'000));
    EXPECT_THROW(solve_with_links(scene, unrefined(false), 130'000), InputError);
}

TEST(ClusterLinks, ApproachTheLightOfAllPairsWhenRefined) {
    const Scene scene = soup(150, 0.15f);
    SolveOptions options = unrefined(false);
    options.refinement.min_area = 1;  // patches remain whole, clusters do not
    const Solution by_pairs = solve_scene(scene, options);
    const auto error = [&](double epsilon) {
        options = unrefined(true);
        options.method.refines = true;
        options.refinement.min_area = 1;
        options.experimental.epsilon = epsilon;
        options.limits.rays = 400'000;
        return difference(solve_scene(scene, options), by_pairs);
    };
    const double coarse = error(1), fine = error(1e-5);
    EXPECT_LT(fine, 0.8 * coarse);
}

TEST(ClusterLinks, LoseLittlePowerInAClosedRoom) {
    const Scene scene = soup(400, 0.1f);
    for (const bool refines : {false, true}) {
        SolveOptions options = unrefined(true);
        options.method.refines = refines;
        options.limits.rays = 1'000'000;
        const IterationReport last = solve_scene(scene, options).iterations.back();
        EXPECT_LT(std::abs(last.escaped_power.x), 0.01 * last.total_power.x) << refines;
    }
}

TEST(ClusterLinks, AreNotMadeIfThePatchesAreFew) {
    const Scene scene = furnished_room();
    SolveOptions with{.method = find_method("hr")};
    with.experimental.epsilon = 1e-3;
    SolveOptions without = with;
    without.experimental.clusters = false;
    EXPECT_EQ(solve_scene(scene, with).irradiance, solve_scene(scene, without).irradiance);
}

TEST(ClusterLinks, TransportImportanceAsLight) {
    const Scene scene = soup(150, 0.1f, Rgb(0.7f));
    SolveOptions options = unrefined(true);
    options.method.importance = ImportanceUse::full;
    options.views = {{View{"room", {0.3f, 0.3f, 1.2f}, {3, 2, 1}, {0, 0, 1}, 60}}};
    for (const bool refines : {false, true}) {
        options.method.refines = refines;
        options.limits.rays = 300'000;
        const Solution s = solve_scene(scene, options);
        const Materials materials(scene);
        const std::vector<Rgb> b = radiosity(materials, *s.forest, s.irradiance);
        double by_light = 0, by_importance = 0;  // sum v P and sum psi A M
        for (ElementIndex e{0}; e < s.forest->size(); ++e) {
            if (!s.forest->is_leaf(e)) continue;
            const auto area = static_cast<double>(s.forest->area(e));
            by_light += area * channel_sum(RgbD(b[e])) * s.view_importance[e];
            by_importance += area * channel_sum(RgbD(materials.exitance(s.forest->patch(e)))) *
                             (s.view_importance[e] + s.indirect_importance[e]);
        }
        EXPECT_NEAR(by_importance / by_light, 1, 1e-4) << refines;
    }
}

}  // namespace
}  // namespace interflect
