// Rays that leave a patch: origins uniform on its area, directions with density cos(theta) / pi. Pearson's chi-square
// test uses cell areas found by clipping, which is independent of the patch's parametrisation.
//
// Seen to fail (scripts/mutation-test) if directions lack the cosine or its root, azimuths cover only 6 radians,
// origins cluster near the centre, or origins are uniform in the parameters of an irregular quadrilateral.

#include "interflect/solver/sampling/ray_maker.h"

#include <ImathMatrix.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using V2d = Imath::V2d;
using V3d = Imath::V3d;
using Polygon = std::vector<V2d>;

constexpr std::size_t ray_count = 200'000;
constexpr float offset = 1e-5f;

/// A patch, by its corners in the plane and the placement of the plane.
struct Shape {
    const char* name;
    Polygon corners;
    float scale = 1;  // [m]
    bool rotated = false;
};

const Polygon triangle{{0, 0}, {2, 0.5}, {0.3, 1}};
const Polygon parallelogram{{0, 0}, {2, 0.5}, {2.3, 1.5}, {0.3, 1}};
const Polygon irregular{{0, 0}, {3, 0.2}, {1.5, 1.4}, {0.2, 0.6}};
const Polygon nearly_triangle{{0, 0}, {2, 0}, {1.02, 1.01}, {1, 1.02}};

std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }

/// The plane of a shape: p -> origin + p.x s + p.y t.
struct Plane {
    V3d origin{0, 0, 0}, s{1, 0, 0}, t{0, 1, 0};
    explicit Plane(const Shape& shape) {
        if (shape.rotated) {
            s = V3d(0.36, 0.48, -0.8);
            t = V3d(-0.8, 0.6, 0);
            origin = V3d(0.3, -0.2, 0.1);
        }
        s *= shape.scale;
        t *= shape.scale;
    }
    V3d normal() const { return s.cross(t).normalized(); }
    V3f point(const V2d& p) const { return V3f(origin + p.x * s + p.y * t); }
    V2d coordinates(const V3f& x) const {
        const V3d d = V3d(x) - origin;
        return {d.dot(s) / s.length2(), d.dot(t) / t.length2()};
    }
};

PatchGeometry geometry_of(const Shape& shape) {
    Scene scene;
    const Plane plane(shape);
    for (const V2d& c : shape.corners) scene.vertices.push_back(plane.point(c));
    Patch patch;
    patch.vertices = {0, 1, 2, shape.corners.size() == 4 ? 3 : none};
    return {scene, patch};
}

std::vector<Ray> rays_of(const Shape& shape, PointSet set, const Cell& cell = {}) {
    std::vector<Ray> rays(ray_count);
    std::vector<Parameters> origins(ray_count);
    PointBlock points;
    shoot_rays(geometry_of(shape), cell, offset * shape.scale, set, 1, 0, points, rays, origins);
    return rays;
}

double area_of(const Polygon& polygon) {
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) area += 0.5 * polygon[i].cross(polygon[(i + 1) % polygon.size()]);
    return area;
}

/// Returns the part of a convex polygon where the linear function `inside` is non-negative.
Polygon clipped(const Polygon& polygon, const std::function<double(const V2d&)>& inside) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = inside(a), at_b = inside(b);
        if (at_a >= 0) part.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) part.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    return part;
}

/// Returns the p-value of the hypothesis that the points are uniform on the polygon, over a grid of cells.
double uniformity(const Polygon& polygon, const std::vector<V2d>& points) {
    constexpr int side = 12;
    constexpr double fewest = 10;  // minimum expected count per cell; smaller cells are pooled
    V2d low = polygon[0], high = polygon[0];
    for (const V2d& p : polygon) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const V2d cell = (high - low) / side;
    const auto index = [](double x) { return std::clamp(static_cast<int>(x), 0, side - 1); };
    std::vector<double> counts(side * side, 0.0);
    for (const V2d& p : points)
        ++counts[static_cast<std::size_t>(index((p.y - low.y) / cell.y) * side + index((p.x - low.x) / cell.x))];

    std::vector<double> observed{0}, expected{0};
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const V2d corner = low + V2d(i * cell.x, j * cell.y);
            Polygon part = clipped(polygon, [&](const V2d& p) { return p.x - corner.x; });
            part = clipped(part, [&](const V2d& p) { return corner.x + cell.x - p.x; });
            part = clipped(part, [&](const V2d& p) { return p.y - corner.y; });
            part = clipped(part, [&](const V2d& p) { return corner.y + cell.y - p.y; });
            const double count = area_of(part) / area_of(polygon) * static_cast<double>(points.size());
            const double seen = counts[static_cast<std::size_t>(j * side + i)];
            if (count < fewest) {
                observed[0] += seen;
                expected[0] += count;
            } else {
                observed.push_back(seen);
                expected.push_back(count);
            }
        }
    if (expected[0] < fewest) {
        observed.back() += observed[0];
        expected.back() += expected[0];
        observed.erase(observed.begin()), expected.erase(expected.begin());
    }
    return chi_square_test(observed, expected);
}

/// Returns the p-value of the hypothesis that directions in the frame (s, t, normal) have the density cos(theta) / pi:
/// cos^2(theta) and the azimuth are independent and uniform.
double cosine_distribution(const std::vector<V3d>& local_directions) {
    constexpr std::size_t rings = 16, sectors = 16;
    std::vector<double> observed(rings * sectors, 0.0);
    for (const V3d& d : local_directions) {
        const double ring = d.z * d.z * rings;
        const double sector = (std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5) * sectors;
        ++observed[std::min(static_cast<std::size_t>(ring), rings - 1) * sectors +
                   std::min(static_cast<std::size_t>(sector), sectors - 1)];
    }
    const std::vector<double> expected(
        observed.size(), static_cast<double>(local_directions.size()) / static_cast<double>(observed.size()));
    return chi_square_test(observed, expected);
}

class ShotRays : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, ShotRays,
                         testing::Values(Shape{"triangle", triangle}, Shape{"parallelogram", parallelogram},
                                         Shape{"irregular", irregular}, Shape{"nearly_triangle", nearly_triangle},
                                         Shape{"small_rotated_triangle", triangle, 1e-3f, true},
                                         Shape{"small_rotated_parallelogram", parallelogram, 1e-3f, true},
                                         Shape{"small_rotated_irregular", irregular, 1e-3f, true},
                                         Shape{"large_rotated_irregular", irregular, 1e3f, true}),
                         [](const auto& test) { return test.param.name; });

TEST_P(ShotRays, BeginUniformlyOnThePatch) {
    const Plane plane(GetParam());
    std::vector<V2d> origins;
    for (const Ray& ray : rays_of(GetParam(), PointSet::random)) origins.push_back(plane.coordinates(ray.origin));
    EXPECT_GT(uniformity(GetParam().corners, origins), false_alarm);
}

TEST_P(ShotRays, BeginLiftedAboveThePatchAndNowhereElse) {
    const Plane plane(GetParam());
    const double scale = GetParam().scale, rounding = 1e-6 * (scale + 1);  // float rounding; the patch is within 3
                                                                           // scale + 0.4 m
    for (const Ray& ray : rays_of(GetParam(), PointSet::sobol)) {
        ASSERT_NEAR((V3d(ray.origin) - plane.origin).dot(plane.normal()), offset * scale, rounding);
        const V2d p = plane.coordinates(ray.origin);
        const Polygon& c = GetParam().corners;
        for (std::size_t i = 0; i < c.size(); ++i)
            ASSERT_GT((c[(i + 1) % c.size()] - c[i]).cross(p - c[i]), -4 * rounding / scale);
    }
}

TEST_P(ShotRays, HaveCosineDistributedUnitDirections) {
    const Plane plane(GetParam());
    std::vector<V3d> directions;
    for (const Ray& ray : rays_of(GetParam(), PointSet::random)) {
        const V3d d(ray.direction);
        ASSERT_NEAR(d.length(), 1, 1e-6);
        ASSERT_GT(d.dot(plane.normal()), 0);
        directions.emplace_back(d.dot(plane.s.normalized()), d.dot(plane.t.normalized()), d.dot(plane.normal()));
    }
    EXPECT_GT(cosine_distribution(directions), false_alarm);
}

TEST_P(ShotRays, HaveDirectionsThatDoNotDependOnTheOrigin) {
    constexpr std::size_t octants = 8;  // of the origin about the centre, and of the direction about the normal
    const Plane plane(GetParam());
    const V3f centre = geometry_of(GetParam()).centre();
    const auto octant = [&](const V3d& d) {
        const double turn = std::atan2(d.dot(plane.t), d.dot(plane.s)) / (2 * std::numbers::pi) + 0.5;
        return std::min(static_cast<std::size_t>(turn * octants), octants - 1);
    };
    std::vector<double> observed(octants * octants, 0.0), from(octants, 0.0), to(octants, 0.0), expected;
    for (const Ray& ray : rays_of(GetParam(), PointSet::random)) {
        const std::size_t a = octant(V3d(ray.origin - centre)), b = octant(V3d(ray.direction));
        ++observed[a * octants + b];
        ++from[a];
        ++to[b];
    }
    for (const double a : from)
        for (const double b : to) expected.push_back(a * b / ray_count);
    EXPECT_GT(chi_square_test(observed, expected, 2 * octants - 1), false_alarm);
}

// Tests that the tests above reject other distributions.

TEST(CosineDistribution, RefusesUniformDirections) {
    std::vector<V3d> directions;
    for (std::uint64_t i = 0; i < ray_count; ++i) {
        const double height = random_double(1, i), turn = 2 * std::numbers::pi * random_double(2, i);
        const double radius = std::sqrt(1 - height * height);
        directions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), height);
    }
    EXPECT_LT(cosine_distribution(directions), false_alarm);
}

TEST(Uniformity, RefusesPointsUniformInTheParametersOfAnIrregularQuadrilateral) {
    const Shape shape{"irregular", irregular};
    const PatchGeometry geometry = geometry_of(shape);
    std::vector<V2d> points;
    for (std::uint64_t i = 0; i < ray_count; ++i)
        points.push_back(Plane(shape).coordinates(
            geometry.point({static_cast<float>(random_double(1, i)), static_cast<float>(random_double(2, i))})));
    EXPECT_LT(uniformity(irregular, points), false_alarm);
}

}  // namespace
}  // namespace interflect
