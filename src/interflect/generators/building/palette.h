#pragma once

#include <cstdint>
#include <vector>

#include "interflect/generators/building/random_sequence.h"
#include "interflect/generators/building/shell.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

/// Materials of rooms and furniture, as indices into Scene::materials. Lists offer a choice.
struct Palette {
    std::vector<std::uint32_t> walls, floors, ceilings;
    std::vector<std::uint32_t> woods, fabrics, papers;
    std::vector<std::uint32_t> lamps;  ///< Emitters: 10,000 to 14,000 lm/m^2, warm to cool white.
    std::uint32_t metal = 0, lacquer = 0, plastic = 0, screen = 0, cardboard = 0;
};

/// Adds all materials to a scene. Reflectances are those of common paints, woods and cloths, 0.03 to 0.85.
Palette add_palette(Scene& scene);

/// Draws the finish of one room from the palette.
Finish draw_finish(const Palette& palette, RandomSequence& random);

}  // namespace interflect::detail::building
