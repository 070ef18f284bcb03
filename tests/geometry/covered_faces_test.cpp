// Faces in one plane: their pairs and uncovered areas, and the limits of the work for faces that lie in each other.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/coverage/covered_area.h"
#include "interflect/geometry/coverage/face_overlap.h"

namespace interflect {

using namespace detail;
namespace {

/// One-sided triangles with one corner, whose legs grow from 1 to 2 m.
Scene nested_triangles(std::uint32_t count) {
    Scene scene;
    scene.vertices.emplace_back(0.0f, 0.0f, 0.0f);
    for (std::uint32_t i = 0; i < count; ++i) {
        const float leg = 1 + static_cast<float>(i) / static_cast<float>(count - 1);
        scene.vertices.emplace_back(leg, 0.0f, 0.0f);
        scene.vertices.emplace_back(0.0f, leg, 0.0f);
        scene.patches.emplace_back();
        scene.patches.back().vertices = {0, 2 * i + 1, 2 * i + 2, none};
    }
    return scene;
}

/// Squares of 1 m in a checkerboard of `side` columns, then a square below all of them.
Scene checkerboard(std::uint32_t side) {
    Scene scene;
    const auto add_square = [&](float x, float y, float size) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (const V3f& corner : {V3f(0, 0, 0), V3f(1, 0, 0), V3f(1, 1, 0), V3f(0, 1, 0)})
            scene.vertices.push_back(V3f(x, y, 0) + size * corner);
        scene.patches.emplace_back();
        scene.patches.back().vertices = {first, first + 1, first + 2, first + 3};
    };
    for (std::uint32_t i = 0; i < side; ++i)
        for (std::uint32_t j = i % 2; j < side; j += 2) add_square(static_cast<float>(i), static_cast<float>(j), 1);
    add_square(0, 0, static_cast<float>(side));
    return scene;
}

std::vector<std::uint32_t> all_but_last(const Scene& scene) {
    std::vector<std::uint32_t> faces(scene.patches.size() - 1);
    std::iota(faces.begin(), faces.end(), 0u);
    return faces;
}

std::size_t pairs_in(const Scene& scene) {
    const std::vector<float> tolerance(scene.patches.size(), 1e-6f);
    return overlapping_faces(scene, std::vector<bool>(scene.patches.size()), tolerance).size();
}

// 20,000 faces are halved 16 times. Fails with a sixteenth of the intersections.
TEST(CoveredArea, IsExactForManyFacesSideBySide) {
    const Scene board = checkerboard(200);
    const auto last = static_cast<std::uint32_t>(board.patches.size() - 1);
    EXPECT_NEAR(uncovered_area_share(board, PatchIndex(last), all_but_last(board), 1e-7f), 0.5, 1e-5);
    EXPECT_EQ(pairs_in(board), last);
}

// The largest triangle but one covers all that the others do. Without a limit, their outlines divide it into ever
// more parts: 2,000 took minutes.
TEST(CoveredArea, OfFacesThatLieInEachOtherNeedsFewIntersections) {
    const Scene nested = nested_triangles(2000);
    const double leg = 1 + 1998.0 / 1999;
    EXPECT_NEAR(uncovered_area_share(nested, PatchIndex(1999), all_but_last(nested), 1e-7f), 1 - leg * leg / 4, 1e-5);
}

TEST(FaceOverlap, FindsAllPairsOfFacesThatLieInEachOther) { EXPECT_EQ(pairs_in(nested_triangles(100)), 4950u); }

// There would be 1,998,000 pairs, and 4.5 * 10^10 of 300,000 faces. Fails without the limit.
TEST(FaceOverlap, RefusesFarMorePairsThanFaces) {
    const Scene nested = nested_triangles(2000);
    EXPECT_THROW(pairs_in(nested), InputError);
}

}  // namespace
}  // namespace interflect
