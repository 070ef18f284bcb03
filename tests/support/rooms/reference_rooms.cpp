#include "tests/support/rooms/reference_rooms.h"

#include <cmath>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

using namespace detail;

namespace {

constexpr int divisions = 3;  // of a wall, in each direction

std::vector<Material> colourful_materials() {
    return {{"red", {0.8f, 0.1f, 0.1f}, {0, 0, 0}},         {"green", {0.2f, 0.7f, 0.1f}, {0.5f, 0, 1}},
            {"blue", {0.1f, 0.3f, 0.8f}, {0, 2, 0}},        {"black", {0, 0, 0}, {0, 0, 0.3f}},
            {"lamp", {0.5f, 0.5f, 0.5f}, {10.0f, 8.0f, 5}}, {"white", {0.85f, 0.8f, 0.75f}, {0, 0, 0}}};
}

/// Adds a box from `low` to `high`, visible from outside.
void add_box(Scene& scene, V3f low, V3f high, std::uint32_t material, int n) {
    const V3f d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    add_rectangle(scene, low, z, y, material, n, n);
    add_rectangle(scene, low + x, y, z, material, n, n);
    add_rectangle(scene, low, x, z, material, n, n);
    add_rectangle(scene, low + y, z, x, material, n, n);
    add_rectangle(scene, low, y, x, material, n, n);
    add_rectangle(scene, low + z, x, y, material, n, n);
}

}  // namespace

Scene colourful_box() { return closed_box({1, 2, 3}, divisions, colourful_materials()); }

Scene open_colourful_box() {
    Scene scene = colourful_box();
    scene.patches.resize(scene.patches.size() - divisions * divisions);  // the last wall is z = 3 m
    return scene;
}

Scene furnished_room() {
    Scene scene = closed_box({4, 3, 2.5f}, divisions, colourful_materials());
    const std::uint32_t yellow = add_material(scene, {0.7f, 0.6f, 0.1f}, {0, 0, 0});
    const std::uint32_t glowing = add_material(scene, {0.4f, 0.5f, 0.6f}, {1, 0.5f, 0.25f});
    add_box(scene, {0.5f, 0.75f, 0.25f}, {1.5f, 2.25f, 1.5f}, yellow, 2);
    add_rectangle(scene, {2.5f, 0.5f, 0.5f}, {0, 2, 0}, {0, 0, 1.5f}, glowing, 2, 2, true);
    return scene;
}

SolveOptions unbiased_options(PointSet points, std::uint64_t seed) {
    SolveOptions options{.method = find_method("srr")};
    options.seed = seed;
    options.experimental.points = points;
    options.experimental.one_bounce = true;
    options.experimental.warm_up = 20;  // the rooms' mean reflectance is below 0.6: 0.6^20 = 4e-5
    options.experimental.iterations = 8;
    options.experimental.rays_per_iteration = 20'000;
    return options;
}

double relative_error(const Scene& scene, const std::vector<Rgb>& irradiance, const std::vector<RgbD>& exact) {
    double area = 0, square = 0, mean = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double a = patch_area(scene, scene.patches[i]);
        const double difference = luminance(RgbD(irradiance[i])) - luminance(exact[i]);
        area += a;
        square += a * difference * difference;
        mean += a * luminance(exact[i]);
    }
    return std::sqrt(square / area) / (mean / area);
}

}  // namespace interflect::testing_support
