#include "interflect/generators/building/rooms/furniture.h"

#include <algorithm>
#include <span>

namespace interflect::detail::building {

namespace {

// All lengths in metres.

struct Books {
    Interval thickness, height, depth;  // height relative to the space between boards
    float chance_of_space = 0;          // after a book
};

constexpr Books books{{.016f, .048f}, {.60f, .92f}, {.14f, .21f}, .10f};
constexpr Books binders{{.045f, .080f}, {.84f, .90f}, {.24f, .26f}, .12f};

std::uint32_t draw_paper(const Palette& palette, RandomSequence& random) {
    return random.pick(std::span(palette.papers));
}

void add_books(const Solids& solids, const V3f& low, const V3f& high, const Books& kind, const Palette& palette,
               RandomSequence& random) {
    for (float x = low.x;;) {
        const float thickness = random.between(kind.thickness.low, kind.thickness.high);
        if (x + thickness > high.x) return;
        const float height = (high.z - low.z) * random.between(kind.height.low, kind.height.high);
        const float depth = std::min(high.y - low.y, random.between(kind.depth.low, kind.depth.high));
        solids.box({x, high.y - depth, low.z}, {x + thickness, high.y, low.z + height}, draw_paper(palette, random));
        x += thickness + gap;
        if (random.chance(kind.chance_of_space)) x += random.between(.03f, .15f);
    }
}

void add_bookcase(const Solids& solids, const V3f& size, int rows, const Books& kind, const Palette& palette,
                  RandomSequence& random) {
    constexpr float board = .02f, back = .01f, plinth = .05f, set_back = .02f;
    const std::uint32_t wood = random.pick(std::span(palette.woods));
    const V3f low(-size.x / 2 + gap, gap, gap), high(size.x / 2 - gap, size.y - gap, size.z);
    solids.box(low, {low.x + board, high.y, high.z}, wood);
    solids.box({high.x - board, low.y, low.z}, high, wood);
    const float left = low.x + board + gap, right = high.x - board - gap;
    solids.box({left, low.y, low.z}, {right, low.y + back, high.z}, wood);
    const float rear = low.y + back + gap;
    const float pitch = (high.z - board - plinth) / static_cast<float>(rows);
    for (int row = 0; row <= rows; ++row) {
        const float z = plinth + pitch * static_cast<float>(row);
        solids.box({left, rear, z}, {right, high.y, z + board}, wood);
        if (row < rows)
            add_books(solids, {left, rear, z + board + gap}, {right, high.y - set_back, z + pitch - gap}, kind, palette,
                      random);
    }
}

void build_bookcase(const Solids& solids, const Palette& palette, RandomSequence& random) {
    add_bookcase(solids, {bookcase.width, bookcase.depth, 2.0f}, 5, books, palette, random);
}

void build_low_bookcase(const Solids& solids, const Palette& palette, RandomSequence& random) {
    add_bookcase(solids, {low_bookcase.width, low_bookcase.depth, .82f}, 2, binders, palette, random);
}

void add_legs(const Solids& solids, float half_x, float half_y, float thickness, float height, std::uint32_t material) {
    for (const float x : {-half_x, half_x})
        for (const float y : {-half_y, half_y})
            solids.box({x - thickness / 2, y - thickness / 2, gap}, {x + thickness / 2, y + thickness / 2, height},
                       material);
}

void add_office_chair(const Solids& solids, const Palette& palette, RandomSequence& random) {
    const std::uint32_t fabric = random.pick(std::span(palette.fabrics));
    add_legs(solids, .20f, .20f, .05f, .06f, palette.plastic);
    solids.tapered_box({-.22f, -.22f, .06f + gap}, {.22f, .22f, .11f}, .3f, palette.plastic);
    solids.box({-.03f, -.03f, .11f + gap}, {.03f, .03f, .42f}, palette.metal);
    solids.box({-.22f, -.22f, .42f + gap}, {.22f, .22f, .48f}, fabric);
    solids.box({-.03f, -.25f - gap, .40f}, {.03f, -.22f - gap, .62f}, palette.plastic);
    solids.box({-.20f, -.26f, .62f + gap}, {.20f, -.21f, 1.00f}, fabric);
    for (const float x : {-.24f, .24f}) {
        solids.box({x - .012f, -.02f, .44f}, {x + .012f, .02f, .64f}, palette.plastic);
        solids.box({x - .025f, -.13f, .64f + gap}, {x + .025f, .11f, .67f}, palette.plastic);
    }
}

void add_chair(const Solids& solids, std::uint32_t wood, std::uint32_t fabric) {
    add_legs(solids, .19f, .18f, .035f, .43f, wood);
    solids.box({-.21f, -.20f, .43f + gap}, {.21f, .20f, .47f}, fabric);
    for (const float x : {-.19f, .19f}) solids.box({x - .015f, -.195f, .47f + gap}, {x + .015f, -.165f, .90f}, wood);
    for (const float z : {.56f, .68f, .80f}) solids.box({-.175f + gap, -.19f, z}, {.175f - gap, -.17f, z + .06f}, wood);
}

void add_pile(const Solids& solids, int count, float thickness, const Palette& palette, RandomSequence& random) {
    for (int i = 0; i < count; ++i) {
        const float z = gap + static_cast<float>(i) * (thickness + gap);
        const float half_x = random.between(.08f, .11f), half_y = random.between(.11f, .15f);
        solids.at({0, 0, 0}, random.between(-.2f, .2f))
            .box({-half_x, -half_y, z}, {half_x, half_y, z + thickness}, draw_paper(palette, random));
    }
}

void add_mug(const Solids& solids, const Palette& palette, RandomSequence& random) {
    solids.tapered_box({-.035f, -.035f, gap}, {.035f, .035f, .10f}, 1.15f, draw_paper(palette, random));
}

void add_monitor(const Solids& solids, const Palette& palette) {
    solids.tapered_box({-.12f, -.08f, gap}, {.12f, .08f, .02f}, .8f, palette.plastic);
    solids.box({-.025f, -.03f, .02f + gap}, {.025f, -.01f, .25f}, palette.plastic);
    solids.box({-.27f, -.01f + gap, .10f}, {.27f, .02f, .43f}, palette.plastic);
    solids.box({-.26f, .02f + gap, .11f}, {.26f, .028f, .42f}, palette.screen);
}

void add_desk_lamp(const Solids& solids, const Palette& palette) {
    solids.tapered_box({-.07f, -.07f, gap}, {.07f, .07f, .025f}, .7f, palette.metal);
    solids.box({-.01f, -.01f, .025f + gap}, {.01f, .01f, .38f}, palette.metal);
    solids.tapered_box({-.09f, -.06f, .38f + gap}, {.09f, .12f, .45f}, .5f, palette.metal);
}

void add_drawers(const Solids& solids, std::uint32_t wood, const Palette& palette) {
    solids.box({-.20f, 0, .03f}, {.20f, .52f, .64f}, wood);
    for (int i = 0; i < 3; ++i) {
        const float z = .05f + .195f * static_cast<float>(i);
        solids.box({-.195f, .52f + gap, z}, {.195f, .54f, z + .185f}, wood);
        solids.box({-.06f, .54f + gap, z + .13f}, {.06f, .555f, z + .145f}, palette.metal);
    }
}

void build_workstation(const Solids& solids, const Palette& palette, RandomSequence& random) {
    constexpr float half_width = .8f - gap, depth = .78f, underside = .71f, top = .735f, side = .025f;
    const std::uint32_t wood = random.pick(std::span(palette.woods));
    solids.box({-half_width, gap, underside}, {half_width, depth, top}, wood);
    for (const float x : {-half_width, half_width - side})
        solids.box({x, .03f, gap}, {x + side, depth - .03f, underside - gap}, wood);
    solids.box({-half_width + side + gap, .05f, .30f}, {half_width - side - gap, .07f, underside - gap}, wood);
    add_drawers(solids.at({.54f, .10f, 0}), wood, palette);

    add_monitor(solids.at({random.between(-.1f, .1f), .22f, top}), palette);
    const Solids keyboard = solids.at({random.between(-.08f, .08f), .60f, top}, random.between(-.1f, .1f));
    keyboard.box({-.22f, -.07f, gap}, {.22f, .07f, .02f}, palette.plastic);
    add_desk_lamp(solids.at({.60f, .20f, top}, random.between(-.5f, .5f)), palette);
    add_mug(solids.at({random.between(.45f, .65f), random.between(.45f, .65f), top}), palette, random);
    add_pile(solids.at({-.58f, .22f, top}, random.between(-.15f, .15f)), 3, .025f, palette, random);
    add_pile(solids.at({-.55f, .59f, top}, random.between(-.15f, .15f)), 2, .003f, palette, random);
    add_office_chair(
        solids.at({random.between(-.25f, .15f), random.between(1.10f, 1.18f), 0}, random.between(-.6f, .6f) + 3.1416f),
        palette, random);
}

void build_cabinet(const Solids& solids, const Palette& palette, RandomSequence& random) {
    constexpr float half_width = .45f - gap, depth = .44f, height = 1.15f, door = .02f;
    constexpr float door_rear = depth - door - gap;
    solids.box({-half_width + .02f, gap, gap}, {half_width - .02f, door_rear - .03f, .06f}, palette.plastic);
    solids.box({-half_width, gap, .06f + gap}, {half_width, door_rear - gap, height}, palette.lacquer);
    for (const float side : {-1.f, 1.f}) {
        const float inner = side * gap / 2, outer = side * half_width;
        solids.box({std::min(inner, outer), door_rear, .08f}, {std::max(inner, outer), door_rear + door - gap, height},
                   palette.lacquer);
        solids.box({side * .05f - .008f, door_rear + door, .65f}, {side * .05f + .008f, door_rear + door + .012f, .80f},
                   palette.metal);
    }
    add_books(solids, {-.40f, .05f, height + gap}, {.05f, .34f, height + .36f}, binders, palette, random);
    solids.at({.25f, .22f, height}, random.between(-.2f, .2f))
        .box({-.12f, -.12f, gap}, {.12f, .12f, .16f}, palette.cardboard);
}

void build_table(const Solids& solids, const Palette& palette, RandomSequence& random) {
    constexpr float half_x = .8f, half_y = .42f, underside = .70f, top = .73f, chair_distance = .62f;
    const std::uint32_t wood = random.pick(std::span(palette.woods));
    const std::uint32_t fabric = random.pick(std::span(palette.fabrics));
    const Solids middle = solids.at({0, table.depth / 2, 0});
    middle.box({-half_x, -half_y, underside}, {half_x, half_y, top}, wood);
    add_legs(middle, half_x - .05f, half_y - .05f, .06f, underside - gap, wood);
    for (const float x : {-.4f, .4f})
        for (const float side : {-1.f, 1.f}) {
            const float turn = random.between(-.25f, .25f) + (side > 0 ? 3.1416f : 0);
            const V3f place(x + random.between(-.04f, .04f), side * (chair_distance + random.between(0, .1f)), 0);
            add_chair(middle.at(place, turn), wood, fabric);
        }
    for (const float x : {-.5f, 0.f, .5f}) {
        const Solids place = middle.at({x + random.between(-.05f, .05f), -.2f, top}, random.between(-.4f, .4f));
        add_pile(place, 2, .004f, palette, random);
        add_mug(middle.at({x + random.between(-.1f, .1f), random.between(.1f, .3f), top}), palette, random);
    }
}

void build_radiator(const Solids& solids, const Palette& palette, RandomSequence&) {
    constexpr int fins = 12;
    constexpr float half_width = .5f - gap, front = .12f, low = .14f, high = .68f, pipe = .03f;
    constexpr float pitch = 2 * half_width / fins;
    for (int i = 0; i < fins; ++i) {
        const float x = -half_width + pitch * static_cast<float>(i);
        solids.box({x, .03f, low}, {x + .03f, front, high}, palette.lacquer);
    }
    for (const float z : {low - gap - pipe, high + gap})
        solids.box({-half_width, .05f, z}, {half_width, .08f, z + pipe}, palette.lacquer);
    for (const float x : {-.4f, .4f})
        solids.box({x - .02f, .05f, gap}, {x + .02f, .08f, low - 2 * gap - pipe}, palette.metal);
}

void build_picture(const Solids& solids, const Palette& palette, RandomSequence& random) {
    constexpr float bar = .03f, thickness = .02f;
    const float half_x = random.between(.25f, .34f), low = random.between(1.2f, 1.35f);
    const float high = low + random.between(.4f, .6f);
    const std::uint32_t wood = random.pick(std::span(palette.woods));
    for (const float z : {low, high - bar}) solids.box({-half_x, gap, z}, {half_x, gap + thickness, z + bar}, wood);
    for (const float x : {-half_x, half_x - bar})
        solids.box({x, gap, low + bar + gap}, {x + bar, gap + thickness, high - bar - gap}, wood);
    solids.box({-half_x + bar + gap, gap, low + bar + gap}, {half_x - bar - gap, gap + thickness / 2, high - bar - gap},
               draw_paper(palette, random));
}

void build_cartons(const Solids& solids, const Palette& palette, RandomSequence& random) {
    float z = gap;
    for (const float half : {.19f, .17f, .14f}) {
        const float height = random.between(.18f, .30f);
        solids.at({0, cartons.depth / 2, 0}, random.between(-.35f, .35f))
            .box({-half, -half, z}, {half, half, z + height}, palette.cardboard);
        z += height + gap;
    }
}

void build_waste_bin(const Solids& solids, const Palette& palette, RandomSequence&) {
    const float y = waste_bin.depth / 2;
    solids.tapered_box({-.11f, y - .11f, gap}, {.11f, y + .11f, .30f}, 1.25f, palette.plastic);
}

}  // namespace

const Furniture bookcase{"bookcase", .96f, .30f, .5f, build_bookcase};
const Furniture low_bookcase{"low-bookcase", 1.2f, .32f, .4f, build_low_bookcase};
const Furniture workstation{"workstation", 1.6f, 1.55f, .1f, build_workstation};
const Furniture cabinet{"cabinet", .9f, .46f, .5f, build_cabinet};
const Furniture table{"table", 1.7f, 2.1f, 0, build_table};
const Furniture radiator{"radiator", 1.0f, .13f, .1f, build_radiator};
const Furniture picture{"picture", .7f, .04f, 0, build_picture};
const Furniture cartons{"cartons", .56f, .56f, 0, build_cartons};
const Furniture waste_bin{"waste-bin", .32f, .32f, 0, build_waste_bin};

void add_luminaire(const Solids& solids, const Palette& palette, RandomSequence& random) {
    constexpr float half_length = .6f, half_width = .3f, thickness = .06f;
    solids.box({-half_length, -half_width, -gap - thickness}, {half_length, half_width, -gap}, palette.lacquer,
               random.pick(std::span(palette.lamps)));
}

}  // namespace interflect::detail::building
