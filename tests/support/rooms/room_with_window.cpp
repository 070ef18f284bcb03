#include "tests/support/rooms/room_with_window.h"

#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

Scene room_with_window(Rgb sky) {
    Scene scene;
    scene.objects = {""};
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    const auto add = [&](V3f corner, V3f u, V3f v, int n) { add_rectangle(scene, corner, u, v, black, n, n, true); };
    add({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, 5);  // floor
    add({0, 0, 3}, {5, 0, 0}, {0, 4, 0}, 1);
    add({5, 0, 0}, {0, 4, 0}, {0, 0, 3}, 1);
    add({0, 0, 0}, {5, 0, 0}, {0, 0, 3}, 1);
    add({0, 4, 0}, {5, 0, 0}, {0, 0, 3}, 1);
    add({0, 0, 0}, {0, 1, 0}, {0, 0, 3}, 1);
    add({0, 2.5f, 0}, {0, 1.5f, 0}, {0, 0, 3}, 1);
    add({0, 1, 0}, {0, 1.5f, 0}, {0, 0, 1}, 1);
    add({0, 1, 2.2f}, {0, 1.5f, 0}, {0, 0, 0.8f}, 1);
    scene.luminaires = {{"sky", 0, UniformSky{sky}}};
    return scene;
}

}  // namespace interflect::testing_support
