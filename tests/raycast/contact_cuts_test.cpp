#include <ImathBox.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/generate.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "interflect/ray_caster.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Creates rays from points on a sphere around the scene to points within its box. They cover every part of it.
std::vector<Ray> random_rays(const Scene& scene, std::size_t count) {
    Imath::Box3f box;
    for (const V3f& v : scene.vertices) box.extendBy(v);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const auto uniform = [&](std::uint64_t k) { return static_cast<float>(random_double(17, 8 * i + k)); };
        const V3f size = box.size();
        const V3f origin = box.min + V3f(uniform(0) * size.x, uniform(1) * size.y, uniform(2) * size.z);
        const float z = 2 * uniform(3) - 1, phi = 2 * std::numbers::pi_v<float> * uniform(4);
        const float r = std::sqrt(1 - z * z);
        rays.push_back({origin, V3f(r * std::cos(phi), r * std::sin(phi), z)});
    }
    return rays;
}

std::vector<Hit> hits_of(const Scene& scene, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    RayCaster(scene).trace(rays, hits);
    return hits;
}

std::map<std::uint32_t, double> material_areas(const Scene& scene) {
    std::map<std::uint32_t, double> areas;
    for (const auto& [material_and_object, area] : face_areas(scene)) areas[material_and_object.first] += area;
    return areas;
}

/// Expects equal areas of materials and equal hits. A few rays in a million may differ, which pass within the rounding
/// of vertices of an edge.
void expect_unchanged(const Scene& scene, const ContactOptions& options) {
    const Scene cut = cut_at_contacts(scene, options);
    EXPECT_THAT(scene_faults(cut), testing::IsEmpty());
    const auto old_areas = material_areas(scene), areas = material_areas(cut);
    ASSERT_EQ(old_areas.size(), areas.size());
    for (const auto& [key, area] : old_areas) EXPECT_NEAR(areas.at(key), area, 1e-5 * area);

    const std::vector<Ray> rays = random_rays(scene, 200'000);
    const std::vector<Hit> before = hits_of(scene, rays), after = hits_of(cut, rays);
    std::size_t different = 0, hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hit += before[i].patch != none;
        if (before[i].patch == none || after[i].patch == none) {
            different += before[i].patch != after[i].patch;
            continue;
        }
        const Patch &a = scene.patches[before[i].patch], &b = cut.patches[after[i].patch];
        different += a.material != b.material || a.object != b.object ||
                     std::abs(before[i].distance - after[i].distance) > 1e-4f * std::max(1.0f, before[i].distance);
    }
    EXPECT_GT(hit, rays.size() / 4);
    EXPECT_LE(different, 4u) << cut.patches.size() << " patches, before " << scene.patches.size();
}

void expect_unchanged(const Scene& scene) {
    expect_unchanged(scene, {});
    expect_unchanged(scene, {.min_extent = static_cast<float>(2 * default_element_size(scene))});
}

TEST(ContactCuts, MadeScenesStayAsTheyAre) {
    expect_unchanged(make_maze({.rooms = 4, .furniture = true}));
    expect_unchanged(make_office({}));
    expect_unchanged(make_boxes({.boxes = 50}));
    for (const float turn : {0.0f, 30.0f}) expect_unchanged(make_two_rooms({.turn = turn, .furniture = true}));
}

TEST(ContactCuts, TheOfficeStaysAsItIs) { expect_unchanged(load_scene(repository() / "scenes/office.mgf")); }

#ifdef INTERFLECT_HAS_REAL_SCENES
TEST(ContactCuts, RealScenesStayAsTheyAre) {
    for (const char* name :
         {"corridor.mgf", "cube.mgf", "examp1.mgf", "floor_gloss.mgf", "office-graz.mgf", "office2.mgf"}) {
        SCOPED_TRACE(name);
        expect_unchanged(load_scene(real_scenes() / name));
    }
}

TEST(ContactCuts, GrowOfficeGrazByLessThanTwoAndAHalfTimes) {
    const Scene scene = load_scene(real_scenes() / "office-graz.mgf");
    const Scene cut = cut_at_contacts(scene, {.min_extent = static_cast<float>(2 * default_element_size(scene))});
    EXPECT_GT(cut.patches.size(), scene.patches.size() * 5 / 4);
    EXPECT_LT(cut.patches.size(), scene.patches.size() * 5 / 2);
}
#endif

}  // namespace
}  // namespace interflect
