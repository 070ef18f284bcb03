#include "interflect/geometry/polygons/triangle_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "interflect/base/numbers/random.h"

namespace interflect {

using namespace detail;
namespace {

using Faces = std::vector<FaceVertices>;

std::size_t quadrilaterals(const Faces& faces) {
    return static_cast<std::size_t>(std::count_if(faces.begin(), faces.end(), [](auto& f) { return f[3] != none; }));
}

const std::vector<V3f> unit_square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

Scene scene_of(const std::vector<V3f>& vertices, const std::vector<V2f>& textures = {},
               const std::vector<V2f>& lightmap = {}) {
    Scene scene;
    scene.vertices = vertices;
    scene.texture_coordinates = textures;
    scene.lightmap_coordinates = lightmap;
    return scene;
}

const std::vector<std::uint32_t> halves_of_square{0, 1, 2, 0, 2, 3};

/// Coordinates of the square's corners: of one linear map, and of two that agree on its diagonal.
const std::vector<V2f> linear{{0.1f, 0}, {0.5f, 0.2f}, {0.4f, 0.8f}, {0, 0.6f}};
const std::vector<V2f> distorted{{0, 0}, {1, 0}, {1, 0.5f}, {0, 1}};

/// Returns the vertices of a face in order, starting with the lowest.
FaceVertices from_lowest(FaceVertices face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

TEST(TrianglePairs, ASquareSplitAlongEitherDiagonalIsOneFace) {
    for (const std::vector<std::uint32_t>& triangles :
         {std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, {0, 1, 3, 3, 1, 2}, {2, 3, 0, 1, 2, 0}}) {
        const Faces faces = merge_triangle_pairs(scene_of(unit_square), triangles);
        ASSERT_EQ(faces.size(), 1u);
        EXPECT_EQ(from_lowest(faces[0]), (FaceVertices{0, 1, 2, 3}));
    }
}

struct Unmergeable {
    const char* name;
    std::vector<V3f> vertices;
    std::vector<std::uint32_t> triangles;
};
void PrintTo(const Unmergeable& pair, std::ostream* out) { *out << pair.name; }

class UnmergeablePair : public testing::TestWithParam<Unmergeable> {};

TEST_P(UnmergeablePair, StaysTwoTriangles) {
    const auto& [name, vertices, triangles] = GetParam();
    const Faces faces = merge_triangle_pairs(scene_of(vertices), triangles);
    ASSERT_EQ(faces.size(), 2u);
    EXPECT_EQ(quadrilaterals(faces), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Of, UnmergeablePair,
    testing::Values(Unmergeable{"Folded", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.001f}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}},
                    Unmergeable{"Concave", {{0, 0, 0}, {1, 0, 0}, {0.3f, 0.3f, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}},
                    Unmergeable{"InALine", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {0, 1, 3, 1, 2, 3}},
                    Unmergeable{"BackToBack", unit_square, {0, 1, 2, 0, 3, 2}},
                    Unmergeable{"Twice", unit_square, {0, 1, 2, 0, 1, 2}}),
    testing::PrintToStringParamName());

struct CoordinatesOfPair {
    const char* name;
    std::vector<V2f> textures, lightmap;
    std::size_t faces;
};
void PrintTo(const CoordinatesOfPair& pair, std::ostream* out) { *out << pair.name; }

class CoordinatesOfPairs : public testing::TestWithParam<CoordinatesOfPair> {};

TEST_P(CoordinatesOfPairs, AreLinearMapsOverEachFace) {
    const auto& [name, textures, lightmap, faces] = GetParam();
    EXPECT_EQ(merge_triangle_pairs(scene_of(unit_square, textures, lightmap), halves_of_square).size(), faces);
}

INSTANTIATE_TEST_SUITE_P(With, CoordinatesOfPairs,
                         testing::Values(CoordinatesOfPair{"LinearTexture", linear, {}, 1},
                                         CoordinatesOfPair{"DistortedTexture", distorted, {}, 2},
                                         CoordinatesOfPair{"LinearLightmap", {}, linear, 1},
                                         CoordinatesOfPair{"DistortedLightmap", {}, distorted, 2},
                                         CoordinatesOfPair{"DistortedLightmapAlone", linear, distorted, 2},
                                         CoordinatesOfPair{"DistortedTextureAlone", distorted, linear, 2},
                                         CoordinatesOfPair{"BothLinear", linear, linear, 1},
                                         CoordinatesOfPair{"PlaceInNoLightmap", linear,
                                                           std::vector<V2f>(4, V2f(std::nanf(""))), 1}),
                         testing::PrintToStringParamName());

/// A grid of cells 1 by 0.7, with its triangles in random order and orientation: all triangles are paired.
TEST(TrianglePairs, AGridIsMergedWholeWhateverTheOrder) {
    constexpr std::uint32_t n = 20;
    std::vector<V3f> vertices;
    for (std::uint32_t i = 0; i < n * n; ++i)
        vertices.emplace_back(static_cast<float>(i % n), 0.7f * static_cast<float>(i / n), 5.0f);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t y = 0; y + 1 < n; ++y)
        for (std::uint32_t x = 0; x + 1 < n; ++x) {
            const std::uint32_t a = y * n + x;
            triangles.push_back({a, a + 1, a + n + 1});
            triangles.push_back({a + n + 1, a + n, a});
        }
    std::uint64_t number = 7;
    for (std::size_t i = triangles.size(); i-- > 1;) std::swap(triangles[i], triangles[(number = mix(number, i)) % i]);
    std::vector<std::uint32_t> corners;
    for (auto& triangle : triangles) {
        std::rotate(triangle.begin(), triangle.begin() + static_cast<int>((number = mix(number, 1)) % 3),
                    triangle.end());
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    const Faces faces = merge_triangle_pairs(scene_of(vertices), corners);
    EXPECT_EQ(faces.size(), (n - 1) * (n - 1));
    EXPECT_EQ(quadrilaterals(faces), faces.size());
    std::set<FaceVertices> cells;
    for (const FaceVertices& face : faces) cells.insert(from_lowest(face));
    EXPECT_TRUE(cells.contains(FaceVertices{0, 1, n + 1, n}));
    EXPECT_EQ(cells.size(), faces.size());
}

/// Triangles around one edge, like the pages of a book, each in the order of the vertices of the last.
std::vector<std::uint32_t> book(std::uint32_t pages) {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t page = 0; page < pages; ++page) corners.insert(corners.end(), {0, 1, page + 2});
    return corners;
}

// All pairs of 300,000 would be 4.5 * 10^10. Fails without the limit.
TEST(TrianglePairs, ComparesFewTrianglesAtAnEdgeHoweverManyMeetThere) {
    constexpr std::uint32_t pages = 300'000;
    std::vector<TriangleEdge> edges;
    for (std::uint32_t page = 0; page < pages; ++page) edges.push_back({7, page, 0});
    std::uint64_t comparisons = 0;
    for_pairs_at_edges(edges, [&](const TriangleEdge& a, const TriangleEdge& b) {
        ASSERT_LT(a.triangle, b.triangle);
        if (++comparisons > 8 * std::uint64_t{pages}) FAIL();
    });
    EXPECT_GT(comparisons, pages);

    std::vector<V3f> vertices{{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t page = 0; page < pages; ++page) {
        const float angle = 6.28f * static_cast<float>(page) / pages;
        vertices.emplace_back(std::cos(angle), std::sin(angle), 0.5f);
    }
    EXPECT_EQ(merge_triangle_pairs(scene_of(vertices), book(pages)).size(), pages);
}

}  // namespace
}  // namespace interflect
