#include "interflect/generate.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/generators/building/walls/solids.h"

namespace interflect {

using namespace detail;

namespace {

constexpr float width = 4, height = 3, thickness = 0.01f;  // of a room and of the partition [m]
constexpr float length = 2 * width + thickness;            // of both rooms together [m]
constexpr float largest_turn = 40;                         // [degrees]; clear of the far walls

std::uint32_t add_material(Scene& scene, const char* name, const Rgb& reflectance, const Rgb& exitance = {0, 0, 0}) {
    scene.materials.push_back({name, reflectance, exitance});
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t add_object(Scene& scene, const char* name) {
    scene.objects.emplace_back(name);
    return static_cast<std::uint32_t>(scene.objects.size() - 1);
}

/// Adds a rectangle that faces u x v.
void add_rectangle(Scene& scene, const V3f& corner, const V3f& u, const V3f& v, std::uint32_t material,
                   std::uint32_t object) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const V3f& x : {corner, corner + u, corner + u + v, corner + v}) scene.vertices.push_back(x);
    scene.patches.push_back(
        {.vertices = {first, first + 1, first + 2, first + 3}, .material = material, .object = object});
}

}  // namespace

Scene make_two_rooms(const TwoRoomsOptions& options) {
    if (!(std::abs(options.turn) <= largest_turn))
        throw InputError(fmt::format("the wall can be turned by up to {} degrees, not {}", largest_turn, options.turn));
    Scene scene;
    scene.name = "two rooms";
    scene.objects.emplace_back();
    const std::uint32_t white = add_material(scene, "white", {0.8f, 0.8f, 0.8f});
    const std::uint32_t grey = add_material(scene, "grey", {0.4f, 0.4f, 0.4f});
    const std::uint32_t wood = add_material(scene, "wood", {0.5f, 0.35f, 0.2f});
    const std::uint32_t lamp = add_material(scene, "lamp", {0.5f, 0.5f, 0.5f}, {5000, 5000, 5000});

    const V3f o(0, 0, 0), x(length, 0, 0), y(0, width, 0), z(0, 0, height);
    const std::uint32_t shell = add_object(scene, "shell");
    add_rectangle(scene, o, x, y, grey, shell);
    add_rectangle(scene, z, y, x, white, shell);
    add_rectangle(scene, o, y, z, white, shell);
    add_rectangle(scene, x, z, y, white, shell);
    add_rectangle(scene, o, z, x, white, shell);
    add_rectangle(scene, y, x, z, white, shell);
    add_rectangle(scene, V3f(1.5f, 1.5f, 2.8f), V3f(0, 1, 0), V3f(1, 0, 0), lamp, add_object(scene, "luminaire"));

    const float radians = options.turn * std::numbers::pi_v<float> / 180;
    const auto wall = building::Placement::turned(V3f(length / 2, width / 2, 0), radians);
    // The corners of a rotated partition lie behind the outer walls.
    const float half = options.turn == 0 ? width / 2 : width / 2 / std::cos(radians) + 0.1f;
    building::Solids(scene, wall, add_object(scene, "wall"))
        .box({-thickness / 2, -half, 0}, {thickness / 2, half, height}, white);
    if (options.furniture) {
        const building::Solids cabinets(scene, wall, add_object(scene, "cabinets"));
        for (const float side : {-1.0f, 1.0f})
            for (const float along : {-1.1f, 0.3f}) {
                const float front = side * (thickness / 2 + 0.5f), back = side * thickness / 2;
                cabinets.box({std::min(front, back), along, 0}, {std::max(front, back), along + 0.9f, 1.2f}, wood);
            }
        building::Solids(scene, wall, add_object(scene, "paper"))
            .box({-0.4f, 0.5f, 1.2f}, {-0.19f, 0.797f, 1.201f}, white);
    }
    scene.views = {
        {.name = "lit", .eye = V3f(0.3f, 0.3f, 1.6f), .look_at = V3f(3.6f, 2.6f, 0.9f), .fov = 65},
        {.name = "dark", .eye = V3f(length - 0.3f, 0.3f, 1.6f), .look_at = V3f(length - 3.6f, 2.6f, 0.9f), .fov = 65}};
    return scene;
}

}  // namespace interflect
