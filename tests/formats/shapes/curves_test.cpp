#include "interflect/formats/shapes/curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace interflect {

using namespace detail;
namespace {

using Imath::V3d;
using std::numbers::pi;

V3d area_vector(const PolygonMesh& mesh, const std::vector<std::uint32_t>& face) {
    V3d sum(0);
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
        sum +=
            0.5 * (mesh.points[face[i]] - mesh.points[face[0]]).cross(mesh.points[face[i + 1]] - mesh.points[face[0]]);
    return sum;
}

double area(const PolygonMesh& mesh) {
    double sum = 0;
    for (const auto& face : mesh.faces) sum += area_vector(mesh, face).length();
    return sum;
}

/// Computes the volume by the divergence theorem; positive if the faces look outwards. Requires a closed mesh.
double volume(const PolygonMesh& mesh) {
    double sum = 0;
    for (const auto& face : mesh.faces) sum += area_vector(mesh, face).dot(mesh.points[face[0]]) / 3;
    return sum;
}

bool is_closed(const PolygonMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& face : mesh.faces)
        for (std::size_t i = 0; i < face.size(); ++i) ++uses[{face[i], face[(i + 1) % face.size()]}];
    return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
        const auto reverse = uses.find({use.first.second, use.first.first});
        return use.second == 1 && reverse != uses.end();
    });
}

std::size_t triangles(const PolygonMesh& mesh) {
    return static_cast<std::size_t>(
        std::count_if(mesh.faces.begin(), mesh.faces.end(), [](const auto& face) { return face.size() == 3; }));
}

const V3d centre(1, 2, 3), tilted = V3d(1, -2, 2) / 3;
const int all_divisions[] = {1, 2, 3, 4, 7, 8, 32};

TEST(Curves, SphereHasTrianglesAtThePolesAndQuadrilateralsElsewhere) {
    const PolygonMesh sphere = make_sphere(centre, 0.5, {4});
    EXPECT_EQ(sphere.faces.size(), 16u * 8);
    EXPECT_EQ(triangles(sphere), 2u * 16);
    EXPECT_EQ(sphere.points.size(), 16u * 7 + 2);
    EXPECT_TRUE(is_closed(sphere));
    for (const V3d& p : sphere.points) EXPECT_NEAR((p - centre).length(), 0.5, 1e-12);
}

TEST(Curves, SphereComesCloseToTheTrueOneAsDivisionsGrow) {
    const double true_area = 4 * pi * 0.25, true_volume = 4.0 / 3 * pi * 0.125;
    EXPECT_NEAR(area(make_sphere(centre, 0.5, {4})) / true_area, 1, 0.04);
    EXPECT_NEAR(area(make_sphere(centre, 0.5, {40})) / true_area, 1, 0.0004);
    EXPECT_NEAR(volume(make_sphere(centre, 0.5, {40})) / true_volume, 1, 0.001);
}

TEST(Curves, NegativeRadiusTurnsTheFrontInside) {
    EXPECT_GT(volume(make_sphere(centre, 0.5, {4})), 0);
    EXPECT_LT(volume(make_sphere(centre, -0.5, {4})), 0);
    EXPECT_GT(volume(make_torus(centre, tilted, 0.2, 0.6, {4})), 0);
    EXPECT_LT(volume(make_torus(centre, tilted, -0.2, -0.6, {4})), 0);
}

TEST(Curves, CylinderLooksAwayFromItsAxis) {
    const V3d end = centre + 2.0 * tilted;
    for (const double radius : {0.5, -0.5}) {
        const PolygonMesh cylinder = make_cone(centre, radius, end, radius, {4});
        EXPECT_EQ(cylinder.faces.size(), 16u);
        EXPECT_EQ(triangles(cylinder), 0u);
        EXPECT_NEAR(area(cylinder), 2 * 32 * 0.5 * std::sin(pi / 16), 1e-12);  // height times 16 chords
        for (const auto& face : cylinder.faces) {
            const V3d from_axis = 0.5 * (cylinder.points[face[0]] + cylinder.points[face[2]]) - 0.5 * (centre + end);
            EXPECT_GT(area_vector(cylinder, face).dot(from_axis) * radius, 0);
        }
    }
}

TEST(Curves, ConeWithATipIsMadeOfTriangles) {
    for (const auto& cone :
         {make_cone(centre, 1, centre + tilted, 0, {4}), make_cone(centre + tilted, 0, centre, 1, {4})}) {
        EXPECT_EQ(cone.faces.size(), 16u);
        EXPECT_EQ(triangles(cone), 16u);
        // The outside of a cone whose tip is up faces slightly up.
        for (const auto& face : cone.faces) EXPECT_GT(area_vector(cone, face).dot(tilted), 0);
    }
}

TEST(Curves, RingLooksAlongItsNormal) {
    const PolygonMesh ring = make_ring(centre, tilted, 0.5, 1, {4}), disk = make_ring(centre, tilted, 0, 1, {4});
    const double polygon = 16 * 0.5 * std::sin(pi / 8);  // area of a regular 16-gon of radius 1
    EXPECT_NEAR(area(ring), 0.75 * polygon, 1e-12);
    EXPECT_NEAR(area(disk), polygon, 1e-12);
    EXPECT_EQ(triangles(ring), 0u);
    EXPECT_EQ(triangles(disk), 16u);
    for (const auto& face : ring.faces) EXPECT_NEAR(area_vector(ring, face).normalized().dot(tilted), 1, 1e-12);
}

TEST(Curves, Torus) {
    const PolygonMesh torus = make_torus(centre, tilted, 0.2, 0.6, {40});
    EXPECT_TRUE(is_closed(torus));
    EXPECT_NEAR(area(torus) / (4 * pi * pi * 0.4 * 0.2), 1, 1e-3);
    EXPECT_NEAR(volume(torus) / (2 * pi * pi * 0.4 * 0.04), 1, 1e-3);
    EXPECT_TRUE(is_closed(make_torus(centre, tilted, 0, 0.6, {4}))) << "without a hole, it meets at its centre";
}

TEST(Curves, EqualAreaFacetsHaveTheAreaOfTheCurvedSurface) {
    const auto lateral = [](double r1, double r2, double height) {
        return pi * std::abs(r1 + r2) * std::hypot(height, r1 - r2);
    };
    for (const int divisions : all_divisions) {
        const Tessellation equal{divisions, true};
        const auto cone = [&](double r1, double r2, double height) {
            return area(make_cone(centre, r1, centre + height * tilted, r2, equal)) / lateral(r1, r2, height);
        };
        EXPECT_NEAR(area(make_sphere(centre, 0.5, equal)) / (4 * pi * 0.25), 1, 1e-12) << divisions;
        EXPECT_NEAR(area(make_sphere(centre, -0.5, equal)) / (4 * pi * 0.25), 1, 1e-12) << divisions;
        EXPECT_NEAR(area(make_ring(centre, tilted, 0, 2, equal)) / (4 * pi), 1, 1e-12) << divisions;
        EXPECT_NEAR(area(make_ring(centre, tilted, 0.5, 2, equal)) / (3.75 * pi), 1, 1e-12) << divisions;
        EXPECT_NEAR(area(make_torus(centre, tilted, 0.2, 0.6, equal)) / (4 * pi * pi * 0.4 * 0.2), 1, 1e-12);
        EXPECT_NEAR(area(make_torus(centre, tilted, -0.0, -0.6, equal)) / (4 * pi * pi * 0.3 * 0.3), 1, 1e-12);
        EXPECT_NEAR(cone(0.5, 0.5, 2), 1, 1e-12) << divisions;
        EXPECT_NEAR(cone(0, 3, 1), 1, 1e-12) << divisions;
        EXPECT_NEAR(cone(3, 1, 0.01), 1, 1e-12) << divisions;
        EXPECT_NEAR(cone(-0.1, -0.2, 20), 1, 1e-12) << divisions;
    }
}

TEST(Curves, EqualAreaKeepsTheHeightOfAConeAndTheShapeOfARing) {
    const PolygonMesh cone = make_cone(centre, 2, centre + 3.0 * tilted, 1, {4, true});
    double low = 10, high = -10, large = 0, small = 10;
    for (const V3d& p : cone.points) {
        const double height = (p - centre).dot(tilted), radius = (p - centre - height * tilted).length();
        low = std::min(low, height);
        high = std::max(high, height);
        large = std::max(large, radius);
        small = std::min(small, radius);
    }
    EXPECT_NEAR(low, 0, 1e-12);
    EXPECT_NEAR(high, 3, 1e-12);
    EXPECT_NEAR(large / small, 2, 1e-12);
    const PolygonMesh ring = make_ring(centre, tilted, 0.5, 1, {4, true});
    const double scale = std::sqrt(pi / (8 * std::sin(pi / 8)));  // of a circle to a regular 16-gon of its area
    for (const V3d& p : ring.points) {
        const double radius = (p - centre).length() / scale;
        EXPECT_TRUE(std::abs(radius - 0.5) < 1e-12 || std::abs(radius - 1) < 1e-12) << radius;
    }
}

TEST(Curves, PrismIsBehindItsOutlineAndClosed) {
    const V3d outline[] = {{0, 0, 5}, {2, 0, 5}, {2, 3, 5}, {0, 3, 5}, {-1, 1, 5}};
    const PolygonMesh prism = make_prism(outline, 2);
    EXPECT_EQ(prism.faces.size(), 7u);
    EXPECT_TRUE(is_closed(prism));
    EXPECT_NEAR(volume(prism), 7.5 * 2, 1e-12);
    for (const V3d& p : prism.points) EXPECT_TRUE(p.z == 5 || p.z == 3);
    const PolygonMesh inwards = make_prism(outline, -2);
    EXPECT_NEAR(volume(inwards), -7.5 * 2, 1e-12);
    for (const V3d& p : inwards.points) EXPECT_TRUE(p.z == 5 || p.z == 7);
}

TEST(Curves, IllegalArgumentsAreRefused) {
    EXPECT_THROW(make_sphere(centre, 0, {4}), std::invalid_argument);
    EXPECT_THROW(make_cone(centre, 0, centre + tilted, 0, {4}), std::invalid_argument);
    EXPECT_THROW(make_cone(centre, 1, centre + tilted, -1, {4}), std::invalid_argument);
    EXPECT_THROW(make_cone(centre, 1, centre, 1, {4}), std::invalid_argument);
    EXPECT_THROW(make_ring(centre, tilted, 1, 1, {4}), std::invalid_argument);
    EXPECT_THROW(make_ring(centre, tilted, -1, 1, {4}), std::invalid_argument);
    EXPECT_THROW(make_torus(centre, tilted, 1, 0.5, {4}), std::invalid_argument);
    EXPECT_THROW(make_torus(centre, tilted, -0.5, 1, {4}), std::invalid_argument);
    EXPECT_THROW(make_prism(std::vector<V3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0), std::invalid_argument);
    EXPECT_THROW(make_prism(std::vector<V3d>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace interflect
