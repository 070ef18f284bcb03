#include "interflect/geometry/search/vertex_weld.h"

#include <gtest/gtest.h>

namespace interflect {

using namespace detail;
namespace {

TEST(VertexWeld, OneVertexForEachPosition) {
    Scene scene;
    VertexWeld weld(scene);
    const std::uint32_t a = weld.vertex({1, 2, 3}), b = weld.vertex({1, 2, 3.0000002f});
    EXPECT_NE(a, b);
    EXPECT_EQ(weld.vertex({1, 2, 3}), a);
    EXPECT_EQ(weld.vertex({1, 2, 3.0000002f}), b);
    EXPECT_EQ(scene.vertices.size(), 2u);
}

TEST(VertexWeld, NegativeZeroIsZero) {
    Scene scene;
    VertexWeld weld(scene);
    EXPECT_EQ(weld.vertex({0, 0, 0}), weld.vertex({-0.0f, 0, -0.0f}));
}

TEST(VertexWeld, VerticesThatOthersAddDoNotDisturbIt) {
    Scene scene;
    VertexWeld weld(scene);
    weld.vertex({0, 0, 0});
    scene.vertices.emplace_back(5.0f, 5.0f, 5.0f);
    EXPECT_EQ(weld.vertex({1, 0, 0}), 2u);
    EXPECT_EQ(weld.vertex({0, 0, 0}), 0u);
}

TEST(VertexWeld, GrowsWithoutLosingAny) {
    Scene scene;
    VertexWeld weld(scene);
    const auto position = [](std::uint32_t i) {
        return V3f(static_cast<float>(i % 100), static_cast<float>(i / 100), 7);
    };
    for (std::uint32_t i = 0; i < 10'000; ++i) ASSERT_EQ(weld.vertex(position(i)), i);
    for (std::uint32_t i = 0; i < 10'000; ++i) ASSERT_EQ(weld.vertex(position(i)), i);
}

}  // namespace
}  // namespace interflect
