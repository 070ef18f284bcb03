#include "interflect/generators/building/walls/palette.h"

#include <span>

namespace interflect::detail::building {

namespace {

// Reflectances are linear Rec. 709.
const Material walls[] = {{.name = "wall_white", .reflectance = {.78f, .77f, .74f}},
                          {.name = "wall_cream", .reflectance = {.76f, .69f, .54f}},
                          {.name = "wall_sage", .reflectance = {.50f, .61f, .47f}},
                          {.name = "wall_sky", .reflectance = {.48f, .60f, .70f}},
                          {.name = "wall_apricot", .reflectance = {.74f, .52f, .36f}},
                          {.name = "wall_rose", .reflectance = {.70f, .45f, .44f}},
                          {.name = "wall_lilac", .reflectance = {.58f, .51f, .66f}},
                          {.name = "wall_clay", .reflectance = {.62f, .34f, .24f}}};
const Material floors[] = {{.name = "floor_oak", .reflectance = {.42f, .28f, .16f}},
                           {.name = "floor_walnut", .reflectance = {.20f, .12f, .07f}},
                           {.name = "floor_linoleum", .reflectance = {.28f, .34f, .33f}},
                           {.name = "floor_carpet_blue", .reflectance = {.10f, .15f, .26f}},
                           {.name = "floor_carpet_red", .reflectance = {.30f, .08f, .07f}}};
const Material ceilings[] = {{.name = "ceiling_white", .reflectance = {.82f, .82f, .81f}},
                             {.name = "ceiling_ivory", .reflectance = {.80f, .77f, .69f}}};
const Material woods[] = {{.name = "beech", .reflectance = {.58f, .42f, .26f}},
                          {.name = "cherry", .reflectance = {.40f, .20f, .10f}},
                          {.name = "ash", .reflectance = {.64f, .54f, .40f}}};
const Material fabrics[] = {{.name = "cloth_charcoal", .reflectance = {.06f, .06f, .07f}},
                            {.name = "cloth_teal", .reflectance = {.05f, .27f, .29f}},
                            {.name = "cloth_mustard", .reflectance = {.55f, .36f, .06f}},
                            {.name = "cloth_plum", .reflectance = {.25f, .08f, .20f}},
                            {.name = "cloth_green", .reflectance = {.12f, .33f, .12f}}};
const Material papers[] = {{.name = "paper_white", .reflectance = {.80f, .80f, .78f}},
                           {.name = "paper_cream", .reflectance = {.72f, .64f, .48f}},
                           {.name = "paper_red", .reflectance = {.52f, .07f, .06f}},
                           {.name = "paper_orange", .reflectance = {.66f, .27f, .05f}},
                           {.name = "paper_yellow", .reflectance = {.72f, .58f, .10f}},
                           {.name = "paper_green", .reflectance = {.08f, .32f, .13f}},
                           {.name = "paper_blue", .reflectance = {.06f, .14f, .42f}},
                           {.name = "paper_navy", .reflectance = {.03f, .05f, .14f}},
                           {.name = "paper_brown", .reflectance = {.20f, .11f, .06f}},
                           {.name = "paper_grey", .reflectance = {.35f, .36f, .38f}}};
const Material lamps[] = {
    {.name = "lamp_warm", .reflectance = {.75f, .75f, .75f}, .exitance = {14900, 11700, 7600}},
    {.name = "lamp_neutral", .reflectance = {.75f, .75f, .75f}, .exitance = {13000, 12000, 10200}},
    {.name = "lamp_cool", .reflectance = {.75f, .75f, .75f}, .exitance = {9600, 10200, 11200}}};

std::uint32_t add(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::vector<std::uint32_t> add(Scene& scene, std::span<const Material> materials) {
    std::vector<std::uint32_t> indices;
    for (const Material& material : materials) indices.push_back(add(scene, material));
    return indices;
}

}  // namespace

Palette add_palette(Scene& scene) {
    Palette palette;
    palette.walls = add(scene, walls);
    palette.floors = add(scene, floors);
    palette.ceilings = add(scene, ceilings);
    palette.woods = add(scene, woods);
    palette.fabrics = add(scene, fabrics);
    palette.papers = add(scene, papers);
    palette.lamps = add(scene, lamps);
    palette.metal = add(scene, {.name = "metal", .reflectance = {.52f, .53f, .54f}});
    palette.lacquer = add(scene, {.name = "lacquer", .reflectance = {.72f, .72f, .70f}});
    palette.plastic = add(scene, {.name = "plastic", .reflectance = {.08f, .08f, .08f}});
    palette.screen = add(scene, {.name = "screen", .reflectance = {.04f, .04f, .05f}});
    palette.cardboard = add(scene, {.name = "cardboard", .reflectance = {.44f, .31f, .19f}});
    return palette;
}

Finish draw_finish(const Palette& palette, RandomSequence& random) {
    Finish finish;
    finish.wall = random.pick(std::span(palette.walls));
    finish.floor = random.pick(std::span(palette.floors));
    finish.ceiling = random.pick(std::span(palette.ceilings));
    return finish;
}

}  // namespace interflect::detail::building
