#include "interflect/geometry/polygons/patch_geometry.h"

#include <ImathMatrix.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace interflect {

using namespace detail;
namespace {

struct Single {
    Scene scene;
    explicit Single(std::vector<V3f> corners) {
        scene.vertices = std::move(corners);
        Patch patch;
        patch.vertices = {0, 1, 2, scene.vertices.size() == 4 ? 3 : none};
        scene.patches = {patch};
    }
    PatchGeometry geometry() const { return {scene, scene.patches[0]}; }
};

struct Shape {
    const char* name;
    std::vector<V3f> corners;
    float area;  // [m^2]
};

std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }

const Shape triangle{"triangle", {{0, 0, 0}, {2, 0, 0}, {0.5f, 3, 0}}, 3};
const Shape square{"square", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1};
const Shape parallelogram{"parallelogram", {{0, 0, 0}, {2, 1, 0}, {3, 4, 0}, {1, 3, 0}}, 5};
const Shape trapezium{"trapezium", {{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}}, 6};
const Shape irregular{"irregular", {{0, 0, 0}, {5, 1, 0}, {3, 4, 0}, {1, 3, 0}}, 11};
// One corner lies on the line between its neighbours: legal, but its jacobian vanishes there.
const Shape straight_corner{"straight_corner", {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 2, 0}}, 2};

/// Scaled, turned and moved; `scale` changes the area by its square.
Shape placed(const char* name, const Shape& shape, float scale, const V3f& offset) {
    Imath::M44f matrix;
    matrix.setAxisAngle(V3f(1, 2, 3).normalized(), 0.7f);
    Shape result{name, {}, shape.area * scale * scale};
    for (const V3f& c : shape.corners) result.corners.push_back(c * scale * matrix + offset);
    return result;
}

class PatchGeometries : public testing::TestWithParam<Shape> {
  protected:
    const Single single_{GetParam().corners};
    const PatchGeometry geometry_ = single_.geometry();
    const float size_ = std::sqrt(GetParam().area);
};
INSTANTIATE_TEST_SUITE_P(Shapes, PatchGeometries,
                         testing::Values(triangle, square, parallelogram, trapezium, irregular, straight_corner,
                                         placed("small_triangle", triangle, 1e-3f, V3f(0.1f)),
                                         placed("small_irregular", irregular, 1e-3f, V3f(0.1f)),
                                         placed("large_irregular", irregular, 1e3f, V3f(10))),
                         [](const auto& test) { return test.param.name; });

TEST_P(PatchGeometries, HasTheAreaOfThePolygon) {
    EXPECT_NEAR(geometry_.area() / GetParam().area, 1, 1e-4);
    EXPECT_EQ(patch_area(single_.scene, single_.scene.patches[0]), geometry_.area());
}

TEST_P(PatchGeometries, HasAUnitNormalByTheRightHandRule) {
    const auto& c = GetParam().corners;
    EXPECT_NEAR(geometry_.normal().length(), 1, 1e-6);
    EXPECT_NEAR(geometry_.normal().dot((c[1] - c[0]).cross(c.back() - c[0]).normalized()), 1, 1e-5);
}

TEST_P(PatchGeometries, PutsTheParametersOfCornersOnTheCorners) {
    const auto& c = GetParam().corners;
    const std::vector<Parameters> at = c.size() == 3 ? std::vector<Parameters>{{0, 0}, {1, 0}, {0, 1}}
                                                     : std::vector<Parameters>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    V3f mean(0);
    for (std::size_t k = 0; k < c.size(); ++k) {
        EXPECT_LT((geometry_.point(at[k]) - c[k]).length(), 1e-6f * (c[k].length() + size_));
        mean += c[k] / static_cast<float>(c.size());
    }
    EXPECT_LT((geometry_.centre() - mean).length(), 1e-6f * (mean.length() + size_));
}

TEST_P(PatchGeometries, FindsTheParametersOfItsPoints) {
    for (float a = 0.05f; a < 1; a += 0.1f)
        for (float b = 0.05f; b < 1; b += 0.1f) {
            const V3f x = geometry_.point(geometry_.uniform_parameters(a, b));
            const V3f back = geometry_.point(geometry_.parameters_of(x));
            ASSERT_LT((back - x).length(), 2e-6f * (x.length() + 10 * size_)) << a << ' ' << b;
        }
}

struct SkewCase {
    const char* name;
    std::vector<V3f> corners;
};
void PrintTo(const SkewCase& skew, std::ostream* out) { *out << skew.name; }

// Convex quadrilaterals far from parallelograms. Meant to fail with Newton's method instead of the closed form, which
// did not converge for the first of them.
class SkewQuadrilaterals : public testing::TestWithParam<SkewCase> {};
INSTANTIATE_TEST_SUITE_P(Corners, SkewQuadrilaterals,
                         testing::Values(SkewCase{"Narrow",
                                                  {{1.841784f, 3.850133f, 0},
                                                   {0.9566491f, 4.369944f, 0},
                                                   {1.294364f, 3.382406f, 0},
                                                   {1.583523f, 3.48129f, 0}}},
                                         SkewCase{"LongSide", {{0, 0, 0}, {10, 0, 0}, {0.6f, 0.9f, 0}, {0, 0.7f, 0}}},
                                         SkewCase{"ShortSide", {{0, 0, 0}, {0.1f, 0, 0}, {1, 3, 0}, {-2, 3, 0}}},
                                         SkewCase{"AlmostSquare",
                                                  {{0, 0, 0}, {1, 0, 0}, {1.001f, 0.001f, 0}, {0, 1, 0}}}),
                         testing::PrintToStringParamName());

TEST_P(SkewQuadrilaterals, HaveParametersThatLeadBackToTheirPoints) {
    for (std::size_t first = 0; first < 4; ++first) {  // for each first corner
        std::vector<V3f> corners = GetParam().corners;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
        const Single single(corners);
        const PatchGeometry geometry = single.geometry();
        for (float u = 0; u <= 1; u += 0.0625f)
            for (float v = 0; v <= 1; v += 0.0625f) {
                const V3f x = geometry.point({u, v}), back = geometry.point(geometry.parameters_of(x));
                ASSERT_LT((back - x).length(), 1e-5f * (1 + x.length())) << first << ' ' << u << ' ' << v;
            }
    }
}

TEST_P(PatchGeometries, ClampsTheParametersOfPointsOutside) {
    const V3f centre = geometry_.centre();
    for (const V3f& corner : GetParam().corners) {
        const Parameters p = geometry_.parameters_of(corner + (corner - centre));
        EXPECT_GE(p.u, 0);
        EXPECT_GE(p.v, 0);
        EXPECT_LE(geometry_.is_triangle() ? p.u + p.v : std::max(p.u, p.v), 1);
    }
}

TEST_P(PatchGeometries, HasAJacobianThatIntegratesToTheArea) {
    constexpr int n = 16;
    double area = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Parameters p{(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n};
            if (!geometry_.is_triangle() || i + j < n - 1)
                area += geometry_.jacobian(p) / (n * n);
            else if (i + j == n - 1)
                area += 0.5 * geometry_.jacobian(p) / (n * n);  // the cell on the diagonal
        }
    EXPECT_NEAR(area / geometry_.area(), 1, 1e-4);
}

// A uniform grid of (a, b) must have the centroid and second moments of the polygon. These are computed from a fan of
// triangles around the first corner.
TEST_P(PatchGeometries, SpreadsUniformParametersUniformlyOverTheArea) {
    const auto& c = GetParam().corners;
    const V3f direction = (c[2] - c[0]).normalized();
    const auto height = [&](const V3f& x) { return static_cast<double>((x - c[0]).dot(direction)); };
    double area = 0, first = 0, second = 0;
    for (std::size_t k = 2; k < c.size(); ++k) {
        const double a = 0.5 * (c[k - 1] - c[0]).cross(c[k] - c[0]).length();
        const double p = height(c[k - 1]), q = height(c[k]);
        area += a;
        first += a * (p + q) / 3;
        second += a * (p * p + p * q + q * q) / 6;
    }
    constexpr int n = 200;
    double mean = 0, mean_square = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const float a = (static_cast<float>(i) + 0.5f) / n, b = (static_cast<float>(j) + 0.5f) / n;
            const double h = height(geometry_.point(geometry_.uniform_parameters(a, b)));
            mean += h / (n * n);
            mean_square += h * h / (n * n);
        }
    EXPECT_NEAR(mean / (first / area), 1, 1e-3);
    EXPECT_NEAR(mean_square / (second / area), 1, 1e-3);
}

TEST(PatchGeometry, TakesASlightlyWarpedQuadrilateral) {
    const Single single({{0, 0, 0}, {1, 0, 0.001f}, {1, 1, 0}, {0, 1, 0.001f}});
    const PatchGeometry geometry = single.geometry();
    EXPECT_NEAR(geometry.area(), 1, 1e-4);
    EXPECT_NEAR(geometry.normal().z, 1, 1e-4);
    const Parameters p = geometry.parameters_of(geometry.point({0.3f, 0.6f}));
    EXPECT_NEAR(p.u, 0.3f, 1e-3);
    EXPECT_NEAR(p.v, 0.6f, 1e-3);
}

}  // namespace
}  // namespace interflect
