#include "interflect/prepare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing::IsEmpty;
using testing_support::add_box;
using testing_support::add_material;
using testing_support::add_rectangle;
using testing_support::face_areas;

constexpr ContactOptions any_aspect{.largest_aspect = 1e9f};

/// A floor of 4 x 3 m at z = 0, face 0, of material 0, moved by `offset`; other objects use material 1.
Scene floor_scene(V3f offset = V3f(0, 0, 0), bool two_sided = false) {
    Scene scene;
    scene.name = "floor";
    add_material(scene, {0.5f, 0.5f, 0.5f}, {0, 0, 0});
    add_material(scene, {0.2f, 0.2f, 0.2f}, {0, 0, 0});
    add_rectangle(scene, offset, V3f(4, 0, 0), V3f(0, 3, 0), 0, 1, 1, two_sided);
    return scene;
}

double area_of_material(const Scene& scene, std::uint32_t material) {
    double area = 0;
    for (const Patch& patch : scene.patches)
        if (patch.material == material) area += patch_area(scene, patch);
    return area;
}

std::size_t count_of_material(const Scene& scene, std::uint32_t material) {
    return static_cast<std::size_t>(std::count_if(scene.patches.begin(), scene.patches.end(),
                                                  [&](const Patch& p) { return p.material == material; }));
}

double contact_length(const Scene& scene) {
    double length = 0;
    for (const Contact& c : scene.contacts) length += static_cast<double>((c.b - c.a).length());
    return length;
}

/// Returns whether every patch of the material lies on one side of the plane, within the tolerance.
bool keeps_to_one_side(const Scene& scene, std::uint32_t material, const V3f& point, const V3f& normal,
                       float tolerance = 1e-5f) {
    return std::all_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
        if (patch.material != material) return true;
        bool above = false, below = false;
        for (int i = 0; i < patch.vertex_count(); ++i) {
            const float h = normal.dot(scene.vertices[patch.vertices[static_cast<std::size_t>(i)]] - point);
            above |= h > tolerance;
            below |= h < -tolerance;
        }
        return !(above && below);
    });
}

void expect_same_surfaces(const Scene& before, const Scene& after) {
    EXPECT_THAT(scene_faults(after), IsEmpty());
    const auto old_areas = face_areas(before), areas = face_areas(after);
    ASSERT_EQ(old_areas.size(), areas.size());
    for (const auto& [key, area] : old_areas) EXPECT_NEAR(areas.at(key), area, 1e-5 * area);
}

/// The floor is cut along the four edges of the leg into its own part, and four or more around it. With fewer cuts, a
/// patch of the floor would lie on both sides of a side of the leg.
TEST(Contacts, ALegOnAFloor) {
    Scene scene = floor_scene();
    add_box(scene, V3f(1, 1, 0), V3f(1.1f, 1.2f, 0.7f), 1);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    EXPECT_EQ(count_of_material(cut, 0), 5u);
    EXPECT_EQ(count_of_material(cut, 1), 6u);
    EXPECT_NEAR(contact_length(cut), 0.6, 1e-5);
    for (const Patch& patch : cut.patches)
        if (patch.material == 0) {
            const V3f centre = PatchGeometry(cut, patch).centre();
            const bool is_under = centre.x > 1 && centre.x < 1.1f && centre.y > 1 && centre.y < 1.2f;
            if (is_under) {
                EXPECT_NEAR(patch_area(cut, patch), 0.02, 1e-6);
            }
        }
}

/// For example of a lamp that emits on one side. Seen to fail when backs receive the material of their fronts.
TEST(Contacts, BacksKeepTheirMaterial) {
    Scene scene;
    const std::uint32_t front = add_material(scene, Rgb(0.5f), Rgb(9)), back = add_material(scene, Rgb(0.5f), Rgb(0));
    add_rectangle(scene, V3f(0), V3f(4, 0, 0), V3f(0, 4, 0), front, 1, 1, true);
    scene.patches[1].material = back;
    add_box(scene, V3f(1, 1, 0), V3f(1.1f, 1.2f, 0.7f), add_material(scene, Rgb(0.5f), Rgb(0)));
    for (const Scene& made : {cut_at_contacts(scene, any_aspect), split_patches(scene, 0.7f, 10'000)}) {
        EXPECT_GE(count_of_material(made, front), 5u);
        EXPECT_EQ(count_of_material(made, back), count_of_material(made, front));
        for (const Patch& patch : made.patches)
            if (patch.material == front) {
                EXPECT_EQ(made.patches[patch.other_side].material, back);
            }
    }
}

TEST(Contacts, RectanglesStayRectangles) {
    Scene scene = floor_scene();
    for (float i = 0; i < 5; ++i)
        add_box(scene, V3f(0.3f + 0.7f * i, 0.2f + 0.5f * i, 0), V3f(0.5f + 0.7f * i, 0.6f + 0.5f * i, 1), 1);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    for (const Patch& patch : cut.patches) {
        ASSERT_FALSE(patch.is_triangle());
        EXPECT_LT(PatchGeometry(cut, patch).shape().twist.length(), 1e-5f);
    }
}

TEST(Contacts, AThinWall) {
    Scene scene = floor_scene();
    add_box(scene, V3f(2, 0, 0), V3f(2.01f, 3, 2.5f), 1);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    EXPECT_EQ(count_of_material(cut, 0), 3u);
    EXPECT_TRUE(keeps_to_one_side(cut, 0, V3f(2, 0, 0), V3f(1, 0, 0)));
    EXPECT_TRUE(keeps_to_one_side(cut, 0, V3f(2.01f, 0, 0), V3f(1, 0, 0)));
}

TEST(Contacts, ATurnedWallOfOneTwoSidedFace) {
    Scene scene = floor_scene();
    const V3f along(std::cos(0.5236f), std::sin(0.5236f), 0);
    add_rectangle(scene, V3f(2, 1.5f, 0) - 5.0f * along, 10.0f * along, V3f(0, 0, 2), 1, 1, 1, true);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    EXPECT_TRUE(keeps_to_one_side(cut, 0, V3f(2, 1.5f, 0), V3f(-along.y, along.x, 0)));
    EXPECT_EQ(count_of_material(cut, 0), 2u);
    EXPECT_EQ(count_of_material(cut, 1), 2u);
}

/// Both are cut: the floor along the box, the box's sides at the height of the floor, which continues inside.
TEST(Contacts, ABoxThatPenetrates) {
    Scene scene = floor_scene();
    add_box(scene, V3f(1, 1, -0.4f), V3f(1.5f, 2, 0.6f), 1);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    EXPECT_EQ(count_of_material(cut, 0), 5u);
    EXPECT_EQ(count_of_material(cut, 1), 2 + 4 * 2u);
    EXPECT_TRUE(keeps_to_one_side(cut, 1, V3f(0, 0, 0), V3f(0, 0, 1)));
}

/// The larger face is cut, in either order. The diagonal of the paper's triangles is not part of its outline.
TEST(Contacts, PaperOnADesk) {
    for (const bool paper_first : {false, true}) {
        Scene scene;
        add_material(scene, {0.5f, 0.5f, 0.5f}, {0, 0, 0});
        add_material(scene, {0.2f, 0.2f, 0.2f}, {0, 0, 0});
        if (!paper_first) add_rectangle(scene, V3f(0, 0, 0), V3f(2, 0, 0), V3f(0, 1, 0), 0);
        add_rectangle(scene, V3f(0.5f, 0.4f, 0), V3f(0.2f, 0, 0), V3f(0, 0.3f, 0), 1);
        Patch& paper = scene.patches.back();
        const auto v = paper.vertices;
        paper.vertices = {v[0], v[1], v[2], none};
        scene.patches.push_back(paper);
        scene.patches.back().vertices = {v[0], v[2], v[3], none};
        if (paper_first) add_rectangle(scene, V3f(0, 0, 0), V3f(2, 0, 0), V3f(0, 1, 0), 0);
        const Scene cut = cut_at_contacts(scene, any_aspect);
        expect_same_surfaces(scene, cut);
        EXPECT_EQ(count_of_material(cut, 0), 5u);
        EXPECT_EQ(count_of_material(cut, 1), 2u);
    }
}

TEST(Contacts, ExactDuplicatesAndNeighboursAreNotCut) {
    Scene scene = floor_scene();
    add_rectangle(scene, V3f(0, 0, 0), V3f(4, 0, 0), V3f(0, 3, 0), 1);
    add_rectangle(scene, V3f(4, 0, 0), V3f(1, 0, 0), V3f(0, 3, 0), 1);
    add_rectangle(scene, V3f(0, 0, 0), V3f(0, 0, 1), V3f(4, 0, 0), 1);
    const Scene cut = cut_at_contacts(scene);
    EXPECT_EQ(cut.patches.size(), scene.patches.size());
    EXPECT_THAT(cut.contacts, IsEmpty());
}

TEST(Contacts, ALegInTheCornerAndOneAtTheEdge) {
    Scene scene = floor_scene();
    add_box(scene, V3f(0, 0, 0), V3f(0.1f, 0.1f, 1), 1);
    add_box(scene, V3f(2, 0, 0), V3f(2.1f, 0.1f, 1), 1);
    const Scene cut = cut_at_contacts(scene, any_aspect);
    expect_same_surfaces(scene, cut);
    EXPECT_LE(count_of_material(cut, 0), 6u);
    EXPECT_NEAR(contact_length(cut), 0.5, 1e-5);
}

/// An object that touches a one-sided floor from below has no effect. A two-sided floor is cut, both sides alike.
TEST(Contacts, OnlyTheLitSidesCount) {
    for (const bool two_sided : {false, true}) {
        Scene scene = floor_scene(V3f(0, 0, 0), two_sided);
        add_rectangle(scene, V3f(1, 1, -0.7f), V3f(1, 1, 0), V3f(0, 0, 0.7f), 1, 1, 1, true);
        const Scene cut = cut_at_contacts(scene, any_aspect);
        expect_same_surfaces(scene, cut);
        EXPECT_EQ(count_of_material(cut, 0), two_sided ? 4u : 1u);
        for (PatchIndex i{0}; i < cut.patches.size(); ++i)
            if (const std::uint32_t other = cut.patches[i].other_side; other != none) {
                EXPECT_EQ(cut.patches[other].other_side, i);
                EXPECT_EQ(cut.patches[other].surface, cut.patches[i].surface);
                EXPECT_LT(
                    PatchGeometry(cut, cut.patches[i]).normal().dot(PatchGeometry(cut, cut.patches[other]).normal()),
                    -0.999f);
            }
    }
}

/// At random places there are about 5 cuts a leg, whose lines cut the plane again and again. In rows the lines are
/// shared.
TEST(Contacts, AHundredLegs) {
    for (const bool in_rows : {false, true}) {
        Scene scene = floor_scene();
        for (int i = 0; i < 100; ++i) {
            const V3f low =
                in_rows ? V3f(0.2f + 0.38f * static_cast<float>(i % 10), 0.1f + 0.29f * static_cast<float>(i / 10), 0)
                        : V3f(0.1f + 3.7f * static_cast<float>(random_double(1, 2 * i)),
                              0.1f + 2.7f * static_cast<float>(random_double(1, 2 * i + 1)), 0);
            add_box(scene, low, low + V3f(0.04f, 0.04f, 0.7f), 1);
        }
        const Scene cut = cut_at_contacts(scene, any_aspect);
        expect_same_surfaces(scene, cut);
        EXPECT_LT(count_of_material(cut, 0), in_rows ? 350u : 600u);
        EXPECT_GT(count_of_material(cut, 0), 200u);
    }
}

TEST(Contacts, TrianglesAndIrregularQuadrilaterals) {
    Scene scene;
    add_material(scene, {0.5f, 0.5f, 0.5f}, {0, 0, 0});
    add_material(scene, {0.2f, 0.2f, 0.2f}, {0, 0, 0});
    scene.objects.emplace_back();
    scene.vertices = {V3f(0, 0, 0), V3f(3, 0, 0), V3f(1, 2, 0),   V3f(4, 0, 0),
                      V3f(8, 1, 0), V3f(7, 3, 0), V3f(5, 2.5f, 0)};
    scene.patches = {{.vertices = {0, 1, 2, none}}, {.vertices = {3, 4, 5, 6}}};
    add_box(scene, V3f(1, 0.5f, 0), V3f(1.2f, 0.7f, 1), 1);
    add_box(scene, V3f(6, 1, 0), V3f(6.2f, 1.7f, 1), 1);
    const Scene cut = cut_at_contacts(scene);
    expect_same_surfaces(scene, cut);
    EXPECT_GT(count_of_material(cut, 0), 10u);
    EXPECT_TRUE(std::any_of(cut.patches.begin(), cut.patches.end(), [](const Patch& p) { return p.is_triangle(); }));
}

/// Areas of the cut parts do not depend on the order of faces.
TEST(Contacts, TheOrderOfFacesDoesNotMatter) {
    Scene scene = floor_scene();
    for (int i = 0; i < 12; ++i) {
        const V3f low(3.3f * static_cast<float>(random_double(2, 2 * i)),
                      2.3f * static_cast<float>(random_double(2, 2 * i + 1)), -0.1f * static_cast<float>(i % 2));
        add_box(scene, low, low + V3f(0.5f + 0.01f * static_cast<float>(i), 0.3f, 0.7f), 1);
    }
    Scene reversed = scene;
    std::reverse(reversed.patches.begin(), reversed.patches.end());
    const auto sorted_areas = [](const Scene& cut) {
        std::vector<float> areas;
        for (const Patch& patch : cut.patches) areas.push_back(patch_area(cut, patch));
        std::sort(areas.begin(), areas.end());
        return areas;
    };
    EXPECT_THAT(sorted_areas(cut_at_contacts(scene)),
                testing::Pointwise(testing::FloatNear(1e-5f), sorted_areas(cut_at_contacts(reversed))));
}

/// 2 km away positions are rounded to 0.1 mm; pieces stay valid and cover the floor.
TEST(Contacts, FarFromTheOrigin) {
    for (const float distance : {100.0f, 2000.0f}) {
        const V3f offset(distance, -distance, distance);
        Scene scene = floor_scene(offset);
        add_box(scene, offset + V3f(1, 1, 0), offset + V3f(1.1f, 1.2f, 0.7f), 1);
        const Scene cut = cut_at_contacts(scene, any_aspect);
        EXPECT_THAT(scene_faults(cut), IsEmpty());
        EXPECT_EQ(count_of_material(cut, 0), 5u);
        EXPECT_NEAR(area_of_material(cut, 0), 12, 1e-3);
    }
}

TEST(Contacts, SmallThingsCanBeIgnored) {
    Scene scene = floor_scene();
    add_box(scene, V3f(1, 1, 0), V3f(1.01f, 1.01f, 0.7f), 1);
    add_box(scene, V3f(2, 1, 0), V3f(2.1f, 1.1f, 0.7f), 1);
    EXPECT_EQ(count_of_material(cut_at_contacts(scene, {.min_extent = 0.05f, .largest_aspect = 1e9f}), 0), 5u);
    EXPECT_GT(count_of_material(cut_at_contacts(scene, any_aspect), 0), 8u);
}

/// The dark side of a wall that ends 1 mm above the floor was 62% too bright with smooth shading.
TEST(Contacts, GapsNarrowerThanAnElementCountAsTouching) {
    const auto cut_below_wall = [](float gap, float min_extent) {
        Scene scene = floor_scene();
        add_box(scene, V3f(2, 0, gap), V3f(2.03f, 3, 2.5f), 1);
        return cut_at_contacts(scene, {.min_extent = min_extent, .largest_aspect = 1e9f});
    };
    const Scene cut = cut_below_wall(0.001f, 0.01f);
    EXPECT_EQ(count_of_material(cut, 0), 3u);
    EXPECT_NEAR(contact_length(cut), 6, 1e-5);
    EXPECT_EQ(cut.vertices[4].z, 0.001f) << "the wall stays where it is";
    EXPECT_EQ(count_of_material(cut_below_wall(0.001f, 0), 0), 1u) << "elements of any size";
    EXPECT_EQ(count_of_material(cut_below_wall(0.006f, 0.01f), 0), 1u) << "wider than an element";
}

TEST(Contacts, APosterCloseToAWall) {
    for (const float distance : {0.002f, -0.002f}) {
        Scene scene = floor_scene();
        add_rectangle(scene, V3f(1, 1, distance), V3f(1.5f, 0, 0), V3f(0, 1, 0), 1);
        const Scene cut = cut_at_contacts(scene, {.min_extent = 0.01f, .largest_aspect = 1e9f});
        EXPECT_EQ(count_of_material(cut, 0), distance > 0 ? 5u : 1u);
    }
}

/// Cuts around each small part would add many patches, and refinement finds the shadows of small parts.
TEST(Contacts, SmallThingsCloseToAFaceAreIgnored) {
    Scene scene = floor_scene();
    add_box(scene, V3f(1, 1, 0.001f), V3f(1.2f, 1.2f, 0.2f), 1);
    EXPECT_EQ(count_of_material(cut_at_contacts(scene, {.min_extent = 0.01f}), 0), 1u);
}

TEST(Contacts, LimitsAreReported) {
    Scene scene = floor_scene();
    for (float i = 0; i < 10; ++i)
        add_box(scene, V3f(0.3f * i + 0.2f, 0.25f * i + 0.2f, 0), V3f(0.3f * i + 0.3f, 0.25f * i + 0.3f, 0.7f), 1);
    const Scene few = cut_at_contacts(scene, {.max_pieces_per_face = 7});
    expect_same_surfaces(scene, few);
    EXPECT_EQ(few.warnings.entries().size(), 1u);
    const Scene whole = cut_at_contacts(scene, {.max_patches = scene.patches.size() + 3});
    EXPECT_EQ(whole.patches.size(), scene.patches.size());
    EXPECT_EQ(whole.warnings.entries().size(), 1u);
    EXPECT_THAT(cut_at_contacts(scene).warnings.entries(), IsEmpty());
}

TEST(Contacts, CuttingTwiceAddsNothing) {
    Scene scene = floor_scene();
    add_box(scene, V3f(1, 1, 0), V3f(1.1f, 1.2f, 0.7f), 1);
    const Scene once = cut_at_contacts(scene);
    EXPECT_EQ(cut_at_contacts(once).patches.size(), once.patches.size());
}

/// A quadrilateral whose fourth corner is 2 cm off the plane of the others keeps its two triangles' surface.
TEST(Contacts, AWarpedQuadrilateralIsCutAsTwoTriangles) {
    Scene scene = floor_scene();
    scene.vertices[2].z = 0.02f;
    add_box(scene, V3f(1, 1, -0.5f), V3f(1.3f, 1.2f, 0.7f), 1);
    const Scene cut = cut_at_contacts(scene);
    EXPECT_GT(count_of_material(cut, 0), 5u);
    expect_same_surfaces(scene, cut);
    EXPECT_TRUE(keeps_to_one_side(cut, 0, scene.vertices[1], V3f(3, 4, 0).normalized()));  // the diagonal
}

/// Boxes of all sizes at all angles, on and through each other.
TEST(Contacts, RandomBoxes) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Scene scene = floor_scene();
        std::uint64_t drawn = 0;
        const auto uniform = [&] { return static_cast<float>(random_double(seed, drawn++)); };
        for (int b = 0; b < 15; ++b) {
            const V3f half(0.02f + 0.5f * uniform(), 0.02f + 0.5f * uniform(), 0.02f + 0.5f * uniform());
            const std::size_t first = scene.vertices.size();
            add_box(scene, -half, half, 1);
            const bool stands = b % 3 == 0;
            const V3f axis =
                stands ? V3f(0, 0, 1) : V3f(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f).normalized();
            const float angle = 6.28f * uniform();
            const V3f place(4 * uniform(), 3 * uniform(), stands ? half.z : uniform());
            for (std::size_t i = first; i < scene.vertices.size(); ++i) {
                const V3f x = scene.vertices[i];  // Rodrigues' formula
                scene.vertices[i] = place + x * std::cos(angle) + axis.cross(x) * std::sin(angle) +
                                    axis * axis.dot(x) * (1 - std::cos(angle));
            }
        }
        const Scene cut = cut_at_contacts(scene);
        expect_same_surfaces(scene, cut);
        EXPECT_GT(cut.patches.size(), scene.patches.size() + 50);
        EXPECT_LT(cut.patches.size(), 100 * scene.patches.size());
    }
}

/// `rows` strips of 4 m x `width`, each of two triangles.
Scene floor_of_slivers(int rows, float width) {
    Scene scene;
    scene.objects = {""};
    add_material(scene, Rgb(0.5f), Rgb(0));
    for (int k = 0; k <= rows; ++k)
        for (const float x : {0.0f, 4.0f}) scene.vertices.emplace_back(x, width * static_cast<float>(k), 0.0f);
    for (std::uint32_t k = 0; k < 2 * static_cast<std::uint32_t>(rows); k += 2) {
        scene.patches.resize(scene.patches.size() + 2);
        scene.patches.end()[-2].vertices = {k, k + 1, k + 3, none};
        scene.patches.end()[-1].vertices = {k, k + 3, k + 2, none};
    }
    return scene;
}

double longest_extent(const Scene& scene) {
    double longest = 0;
    for (const Patch& patch : scene.patches) {
        const V3f& a = scene.vertices[patch.vertices[0]];
        for (const std::uint32_t v : patch.vertices)
            if (v != none) longest = std::max(longest, static_cast<double>((scene.vertices[v] - a).length()));
    }
    return longest;
}

/// A floor 1.3 m wide of slivers 1.3 cm wide: pieces of 1.3 m / 16 at most. Quartering alone would leave elements long.
TEST(Contacts, SliversOfAFloorAreCutAcross) {
    const Scene scene = floor_of_slivers(100, 0.013f), cut = cut_at_contacts(scene);
    expect_same_surfaces(scene, cut);
    EXPECT_LT(longest_extent(cut), 1.3 / 16 + 0.02);
    EXPECT_LT(cut.patches.size(), 100 * scene.patches.size());
    EXPECT_EQ(cut.contacts.size(), 0u);
}

TEST(Contacts, StripsThatAreSurfacesByThemselvesStayWhole) {
    const Scene scene = floor_of_slivers(1, 0.013f);
    EXPECT_EQ(cut_at_contacts(scene).patches.size(), scene.patches.size());
}

TEST(Contacts, CompactFacesStayWhole) {
    const Scene scene = floor_of_slivers(4, 0.8f);
    EXPECT_EQ(cut_at_contacts(scene).patches.size(), scene.patches.size());
}

}  // namespace
}  // namespace interflect
