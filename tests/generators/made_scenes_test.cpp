// Properties of all generated scenes: mazes, offices, rooms of boxes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/generate.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"

namespace interflect {

using namespace detail;
namespace {

using Imath::Box3d;
using Imath::V3d;

struct MadeScene {
    std::string name;
    std::function<Scene(std::uint64_t seed)> make;
};
std::ostream& operator<<(std::ostream& out, const MadeScene& made) { return out << made.name; }

class MadeScenes : public testing::TestWithParam<MadeScene> {
  protected:
    Scene scene = GetParam().make(1);
};

bool is_shell(const Scene& scene, const Patch& patch) { return scene.objects[patch.object].ends_with(".shell"); }

TEST_P(MadeScenes, HaveNoFaults) { EXPECT_THAT(scene_faults(scene), testing::IsEmpty()); }

TEST_P(MadeScenes, NamesAreDifferent) {
    EXPECT_EQ(std::set(scene.objects.begin(), scene.objects.end()).size(), scene.objects.size());
    std::set<std::string> materials, views;
    for (const Material& material : scene.materials) EXPECT_TRUE(materials.insert(material.name).second);
    for (const View& view : scene.views) EXPECT_TRUE(views.insert(view.name).second);
}

std::string text_of(const Scene& scene) {
    std::string text;
    const auto append = [&](const auto& value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const V3f& v : scene.vertices) append(v);
    for (const Patch& patch : scene.patches) {
        append(patch.vertices);
        text += scene.objects[patch.object] + scene.materials[patch.material].name;
    }
    for (const View& view : scene.views) append(view.eye);
    return text;
}

TEST_P(MadeScenes, DependOnTheSeedAlone) {
    EXPECT_TRUE(text_of(GetParam().make(1)) == text_of(scene));
    EXPECT_FALSE(text_of(GetParam().make(2)) == text_of(scene));
}

TEST_P(MadeScenes, SurfacesAreClosed) {
    // Each edge belongs to two patches, in opposite directions: no gap, no T-vertex, no duplicate patch.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Patch& patch : scene.patches) {
        ASSERT_EQ(patch.other_side, none) << "all faces are one-sided";
        for (int k = 0; k < patch.vertex_count(); ++k) {
            const std::pair edge(patch.vertices[k], patch.vertices[(k + 1) % patch.vertex_count()]);
            ASSERT_TRUE(edges.insert(edge).second) << "an edge is used twice in one direction";
        }
    }
    for (const auto& [from, to] : edges) ASSERT_TRUE(edges.contains({to, from})) << "an edge has one patch only";
}

/// A convex solid in the scene: six consecutive patches with their own vertices.
struct Solid {
    std::string object;
    std::vector<V3d> vertices, normals;
    Box3d bounds;
};

std::vector<Solid> solids_of(const Scene& scene) {
    std::vector<Solid> solids;
    std::uint32_t next = 0;  // the first patch outside all solids so far
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        if (is_shell(scene, scene.patches[i]) || i < next) continue;
        next = i + 6;
        Solid& solid = solids.emplace_back();
        solid.object = scene.objects[scene.patches[i].object];
        std::set<std::uint32_t> vertices;
        for (std::uint32_t face = i; face < next; ++face) {
            const Patch& patch = scene.patches.at(face);
            vertices.insert(patch.vertices.begin(), patch.vertices.end());
            const auto at = [&](int k) { return V3d(scene.vertices[patch.vertices[k]]); };
            solid.normals.push_back((at(2) - at(0)).cross(at(3) - at(1)).normalized());
        }
        EXPECT_EQ(vertices.size(), 8u) << solid.object;
        for (const std::uint32_t v : vertices) {
            solid.vertices.emplace_back(scene.vertices[v]);
            solid.bounds.extendBy(solid.vertices.back());
        }
    }
    return solids;
}

TEST_P(MadeScenes, SolidsLookOutwards) {
    for (const Solid& solid : solids_of(scene)) {
        V3d centre(0);
        for (const V3d& v : solid.vertices) centre += v / 8.0;
        for (const V3d& normal : solid.normals) {
            const auto ahead = [&](const V3d& v) { return (v - centre).dot(normal); };
            // Convex: the four vertices of a face are the farthest along its normal, all of them in its plane.
            std::vector<double> distances;
            for (const V3d& v : solid.vertices) distances.push_back(ahead(v));
            std::sort(distances.begin(), distances.end());
            ASSERT_GT(distances[4], 0) << solid.object;
            ASSERT_NEAR(distances[4], distances[7], 1e-4) << solid.object;
            ASSERT_LT(distances[3], distances[4]) << solid.object;
        }
    }
}

/// Computes a lower bound of the distance between two solids [m], negative if they overlap: the largest gap between
/// their projections on a face normal of either, or on a cross product of two.
double separation(const Solid& a, const Solid& b) {
    const auto projected = [](const Solid& solid, const V3d& axis) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const V3d& v : solid.vertices) {
            low = std::min(low, v.dot(axis));
            high = std::max(high, v.dot(axis));
        }
        return std::pair(low, high);
    };
    double best = -HUGE_VAL;
    const auto try_axis = [&](const V3d& axis) {
        const auto [a_low, a_high] = projected(a, axis);
        const auto [b_low, b_high] = projected(b, axis);
        best = std::max({best, a_low - b_high, b_low - a_high});
    };
    for (const Solid* solid : {&a, &b})
        for (const V3d& normal : solid->normals) try_axis(normal);
    for (const V3d& m : a.normals)
        for (const V3d& n : b.normals)
            if (const V3d cross = m.cross(n); cross.length() > 1e-3) try_axis(cross.normalized());
    return best;
}

constexpr double promised_distance = 0.004 - 1e-4;  // [m], less rounding

TEST_P(MadeScenes, SolidsKeepTheirDistance) {
    std::vector<Solid> solids = solids_of(scene);
    std::sort(solids.begin(), solids.end(),
              [](const Solid& a, const Solid& b) { return a.bounds.min.x < b.bounds.min.x; });
    for (std::size_t i = 0; i < solids.size(); ++i) {
        Box3d near = solids[i].bounds;
        near.min -= V3d(promised_distance);
        near.max += V3d(promised_distance);
        for (std::size_t j = i + 1; j < solids.size() && solids[j].bounds.min.x <= near.max.x; ++j)
            if (near.intersects(solids[j].bounds)) {
                ASSERT_GE(separation(solids[i], solids[j]), promised_distance)
                    << solids[i].object << " at " << solids[i].bounds.center() << " and " << solids[j].object << " at "
                    << solids[j].bounds.center();
            }
    }
}

/// Returns "room-12" of "room-12.bookcase-3".
std::string room_of(const std::string& object) { return object.substr(0, object.find('.')); }

/// Returns the interior of each room: from its floor (z = 0) to its ceiling, both of the room's size. Excludes
/// thresholds.
std::map<std::string, Box3d> rooms_of(const Scene& scene) {
    std::map<std::string, Box3d> rooms;
    for (const Patch& patch : scene.patches) {
        const V3f corner = scene.vertices[patch.vertices[0]];
        if (!is_shell(scene, patch) || PatchGeometry(scene, patch).normal() != V3f(0, 0, -1) || corner.z < 2.5f)
            continue;
        Box3d& room = rooms[room_of(scene.objects[patch.object])];
        for (const std::uint32_t v : patch.vertices) {
            room.extendBy(V3d(scene.vertices[v]));
            room.extendBy(V3d(scene.vertices[v]) * V3d(1, 1, 0));
        }
    }
    return rooms;
}

TEST_P(MadeScenes, SolidsAreInTheirRooms) {
    const std::map<std::string, Box3d> rooms = rooms_of(scene);
    for (const Solid& solid : solids_of(scene)) {
        const Box3d& room = rooms.at(room_of(solid.object));
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(solid.bounds.min[axis] - room.min[axis], promised_distance) << solid.object;
            ASSERT_GE(room.max[axis] - solid.bounds.max[axis], promised_distance) << solid.object;
        }
    }
}

V3f uniform_direction(std::uint64_t key, std::uint64_t index) {
    const auto words = random_words(key, index);
    const float z = 2 * unit_float(words[0]) - 1, angle = 2 * std::numbers::pi_v<float> * unit_float(words[1]);
    const float r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST_P(MadeScenes, NoRayEscapes) {
    constexpr std::uint64_t count = 100'000;
    const RayCaster ray_caster(scene);
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto words = random_words(1, i);
        const PatchIndex index(words[0] % scene.patches.size());
        const Patch& patch = scene.patches[index];
        const PatchGeometry geometry(scene, patch);
        V3f direction = uniform_direction(2, i);
        if (direction.dot(geometry.normal()) < 0) direction = -direction;
        const V3f origin = geometry.point(geometry.uniform_parameters(unit_float(words[1]), unit_float(words[2])));
        rays.push_back({origin + ray_caster.ray_offset(PatchIndex(index)) * geometry.normal(), direction});
    }
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    EXPECT_EQ(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.patch == none; }), 0);
}

TEST_P(MadeScenes, EyesHaveRoomAroundThem) {
    constexpr std::uint64_t directions = 2000;
    constexpr float arm = 0.3f;  // [m]
    const RayCaster ray_caster(scene);
    for (const View& view : scene.views) {
        if (view.name == "overview") continue;
        EXPECT_TRUE(view.fov >= 45 && view.fov <= 60);
        std::vector<Ray> rays;
        for (std::uint64_t i = 0; i < directions; ++i) rays.push_back({view.eye, uniform_direction(3, i)});
        std::vector<Hit> hits(rays.size());
        ray_caster.trace(rays, hits);
        for (const Hit& hit : hits) ASSERT_TRUE(hit.patch != none && hit.distance > arm) << view.name;
    }
}

TEST_P(MadeScenes, LightShinesDownwardsOnly) {
    for (const Patch& patch : scene.patches)
        if (channel_sum(scene.materials[patch.material].exitance) > 0) {
            ASSERT_EQ(PatchGeometry(scene, patch).normal(), V3f(0, 0, -1));
        }
}

INSTANTIATE_TEST_SUITE_P(
    , MadeScenes,
    testing::Values(
        MadeScene{"maze", [](std::uint64_t seed) { return make_maze({.rooms = 23, .seed = seed}); }},
        MadeScene{"one_room",
                  [](std::uint64_t seed) { return make_maze({.rooms = 1, .furniture = true, .seed = seed}); }},
        MadeScene{"furnished_maze",
                  [](std::uint64_t seed) { return make_maze({.rooms = 60, .furniture = true, .seed = seed}); }},
        MadeScene{"office", [](std::uint64_t seed) { return make_office({.seed = seed}); }},
        MadeScene{"offices",
                  [](std::uint64_t seed) {
                      return make_office({.rooms = 5, .desk_rows = 4, .desks_per_row = 10, .seed = seed});
                  }},
        MadeScene{"smallest_office",
                  [](std::uint64_t seed) { return make_office({.desk_rows = 1, .desks_per_row = 1, .seed = seed}); }},
        MadeScene{"boxes", [](std::uint64_t seed) { return make_boxes({.seed = seed}); }},
        MadeScene{"many_boxes", [](std::uint64_t seed) { return make_boxes({.boxes = 2000, .seed = seed}); }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace interflect
