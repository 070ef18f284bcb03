#include "tests/support/scenes/textured_scenes.h"

#include "interflect/base/numbers/random.h"
#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

using namespace detail;

namespace {

constexpr float bright_rho = 0.8f, bright_exitance = 100;

Scene room_without_floor() {
    Scene scene;
    scene.name = "half dark";
    scene.objects = {""};
    const std::uint32_t wall = add_material(scene, Rgb(0.5f), Rgb(0));
    add_rectangle(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, wall, 2, 2);
    add_rectangle(scene, {4, 0, 0}, {0, 0, 2}, {0, 2, 0}, wall, 2, 2);
    add_rectangle(scene, {0, 0, 0}, {0, 0, 2}, {4, 0, 0}, wall, 2, 4);
    add_rectangle(scene, {0, 2, 0}, {4, 0, 0}, {0, 0, 2}, wall, 4, 2);
    add_rectangle(scene, {0, 0, 2}, {0, 2, 0}, {4, 0, 0}, wall, 2, 4);
    return scene;
}

void add_lamp(Scene& scene) {
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(1000));
    add_rectangle(scene, {2.8f, 0.8f, 1.9f}, {0, 0.4f, 0}, {0.4f, 0, 0}, lamp);
}

}  // namespace

Scene textured_furnace(const Rgb& radiosity) {
    constexpr float rho = 0.9f, min_texel = 0.2f;
    constexpr std::uint32_t side = 16;
    Scene scene = closed_box({1, 2, 3}, 3, {{"wall", Rgb(rho), Rgb(1)}});
    Texture reflectance{"reflectance", side, side, {}}, exitance{"exitance", side, side, {}};
    for (std::uint64_t i = 0; i < side * side; ++i) {
        Rgb texel;
        for (std::uint64_t c = 0; c < 3; ++c)
            texel[static_cast<int>(c)] = min_texel + (1 - min_texel) * static_cast<float>(mix(i, c) % 1'000) / 1'000;
        reflectance.texels.push_back(texel);
        exitance.texels.push_back((Rgb(1) - texel * rho) * radiosity);
    }
    scene.textures = {reflectance, exitance};
    scene.materials[0].reflectance_texture = 0;
    scene.materials[0].exitance_texture = 1;
    for (const V3f& x : scene.vertices)
        scene.texture_coordinates.emplace_back(0.3f * x.x + 0.5f * x.y - 0.1f * x.z,
                                               0.6f * x.z - 0.2f * x.x + 0.1f * x.y);
    return scene;
}

Scene half_dark_floor(Halves halves) {
    constexpr std::uint32_t columns = 64;
    Scene scene = room_without_floor();
    if (halves == Halves::reflect) add_lamp(scene);
    scene.textures = {{"half", columns, 1, {}}};
    for (std::uint32_t i = 0; i < columns; ++i) scene.textures[0].texels.emplace_back(i < columns / 2 ? 0.0f : 1.0f);
    Material floor{"floor", Rgb(bright_rho), Rgb(0)};
    if (halves == Halves::emit) floor = {"floor", Rgb(0), Rgb(bright_exitance)};
    (halves == Halves::emit ? floor.exitance_texture : floor.reflectance_texture) = 0;
    scene.materials.push_back(floor);
    add_rectangle(scene, {0, 0, 0}, {4, 0, 0}, {0, 2, 0}, static_cast<std::uint32_t>(scene.materials.size() - 1));
    for (const V3f& x : scene.vertices) scene.texture_coordinates.emplace_back(x.x / 4, x.y);
    return scene;
}

Scene half_dark_floor_of_two_patches(Halves halves) {
    Scene scene = room_without_floor();
    if (halves == Halves::reflect) add_lamp(scene);
    const std::uint32_t dark = add_material(scene, Rgb(0), Rgb(0));
    const std::uint32_t bright = halves == Halves::reflect ? add_material(scene, Rgb(bright_rho), Rgb(0))
                                                           : add_material(scene, Rgb(0), Rgb(bright_exitance));
    add_rectangle(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, dark);
    add_rectangle(scene, {2, 0, 0}, {2, 0, 0}, {0, 2, 0}, bright);
    return scene;
}

}  // namespace interflect::testing_support
