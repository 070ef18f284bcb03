#include "tests/checks/rooms.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

Scene two_sided_room(V3f size) {
    constexpr int pieces = 8;
    Scene scene;
    scene.name = "room";
    add_material(scene, Rgb(0.5f), Rgb(0));
    const V3f x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0, 0, 0);
    for (const auto& [corner, u, v] : {std::array{o, y, z}, std::array{x, z, y}, std::array{o, z, x},
                                       std::array{y, x, z}, std::array{o, x, y}, std::array{z, y, x}})
        add_rectangle(scene, corner, u, v, 0, pieces, pieces, true);
    return scene;
}

Scene thick_walled_room(V3f size, float thickness) {
    Scene scene = closed_box(size, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    add_box(scene, V3f(-thickness), size + V3f(thickness), 0);
    return scene;
}

void add_two_sided_box(Scene& scene, V3f low, V3f high, std::uint32_t material) {
    const V3f size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    for (const auto& [corner, u, v] : {std::array{low, y, z}, std::array{low + x, z, y}, std::array{low, z, x},
                                       std::array{low + y, x, z}, std::array{low, x, y}, std::array{low + z, y, x}})
        add_rectangle(scene, corner, u, v, material, 1, 1, true);
}

void open_ceiling(Scene& scene, V2f low, V2f high) {
    float ceiling = 0;
    for (const V3f& x : scene.vertices) ceiling = std::max(ceiling, x.z);
    const auto is_within = [&](const Patch& patch) {
        return std::all_of(patch.vertices.begin(), patch.vertices.end(), [&](std::uint32_t i) {
            const V3f& x = scene.vertices[i];
            return x.z == ceiling && x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y;
        });
    };
    PerPatch<Patch> left;
    for (const Patch& patch : scene.patches)
        if (!is_within(patch)) left.push_back(patch);
    for (std::uint32_t i = 0; i < left.size(); ++i) left[i].other_side = PatchIndex(i % 2 == 0 ? i + 1 : i - 1);
    scene.patches = std::move(left);
}

std::shared_ptr<PhotometricWeb> downlight() {
    auto web = std::make_shared<PhotometricWeb>();
    web->name = "downlight.ies";
    web->polar = {0, 90}, web->azimuth = {0, 360};
    web->intensities = {100, 100, 100, 100};
    return web;
}

void add_light(Scene& scene, std::shared_ptr<const PhotometricWeb> web, V3f position, V3f direction) {
    MeasuredLight light;
    light.web = std::move(web);
    light.position = position;
    light.direction = direction;
    if (direction.x != 0) light.c0 = {0, 0, 1};
    scene.luminaires.push_back({"light", 0, light});
}

}  // namespace interflect::testing_support
