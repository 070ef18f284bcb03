#include "interflect/generate.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>

#include "interflect/core.h"
#include "interflect/generators/building/rooms/furnish.h"
#include "interflect/generators/building/rooms/room_views.h"
#include "interflect/generators/building/walls/shell.h"
#include "interflect/generators/patterns.h"

namespace interflect {

using namespace detail;

namespace {

using namespace building;

constexpr float cell = 1.2f;                                       // side of the floor per box [m]
constexpr float luminaire_pitch = 3.6f;                            // [m]
constexpr Interval half_side{.10f, .36f}, box_height{.10f, 1.4f};  // [m]

void add_box(Scene& scene, const V3f& cell_centre, std::uint32_t object, const Palette& palette,
             RandomSequence& random) {
    const float x = random.between(half_side.low, half_side.high), y = random.between(half_side.low, half_side.high);
    const float slack = cell / 2 - gap - std::hypot(x, y);
    const V3f place = cell_centre + V3f(random.between(-slack, slack), random.between(-slack, slack), 0);
    const float turn = random.between(0, std::numbers::pi_v<float>);
    Solids(scene, Placement::turned(place, turn), object)
        .box({-x, -y, gap}, {x, y, random.between(box_height.low, box_height.high)},
             random.pick(std::span(palette.papers)));
}

void add_textures(Scene& scene, const Palette& palette, std::uint32_t floor) {
    constexpr float tiles = 1.2f;  // [m]
    scene.materials[floor].reflectance_texture = add_texture(scene, make_tiles());
    const std::uint32_t label = add_texture(scene, make_label()), louvres = add_texture(scene, make_louvres());
    for (const std::uint32_t paper : palette.papers) scene.materials[paper].reflectance_texture = label;
    for (const std::uint32_t lamp : palette.lamps) scene.materials[lamp].exitance_texture = louvres;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (scene.materials[scene.patches[i].material].is_textured())
            lay_image(scene, i, scene.patches[i].material == floor ? tiles : 0);
}

}  // namespace

Scene make_boxes(const BoxesOptions& options) {
    if (options.boxes < 1 || options.boxes > BoxesOptions::max_boxes)
        throw InputError(fmt::format("there can be 1 to {} boxes, not {}", BoxesOptions::max_boxes, options.boxes));
    // The first cell stays free for the camera.
    const auto columns = std::max(4u, static_cast<std::uint32_t>(std::ceil(std::sqrt(options.boxes + 1.0))));
    const float half = cell * static_cast<float>(columns) / 2;
    FloorPlan plan;
    plan.rooms.push_back({{-half, half}, {-half, half}});

    Scene scene;
    scene.name = fmt::format("{} boxes", options.boxes);
    scene.objects.emplace_back();
    const Palette palette = add_palette(scene);
    RandomSequence random(mix(options.seed, 0));
    const Finish finish = draw_finish(palette, random);
    add_shell(scene, plan, std::span(&finish, 1));
    Furnisher(scene, palette, 0, random).add_luminaires(plan.rooms[0], plan.room_height, luminaire_pitch, false);

    scene.objects.emplace_back("room-0.boxes");
    const auto object = static_cast<std::uint32_t>(scene.objects.size() - 1);
    for (std::uint32_t i = 1; i <= options.boxes; ++i) {
        const std::uint32_t row = i / columns, column = i % columns;
        const V3f centre(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f, 0);
        add_box(scene, V3f(-half, -half, 0) + centre * cell, object, palette, random);
    }
    if (options.texture) add_textures(scene, palette, finish.floor);
    scene.views = {room_view(plan, 0).view, bird_view(plan)};
    return scene;
}

}  // namespace interflect
