#pragma once

#include <cstdint>
#include <vector>

#include "interflect/generators/building/plan/random_sequence.h"
#include "interflect/generators/building/walls/shell.h"
#include "interflect/scene.h"

namespace interflect::detail::building {

/// Indices into Scene::materials.
struct Palette {
    std::vector<std::uint32_t> walls, floors, ceilings;
    std::vector<std::uint32_t> woods, fabrics, papers;
    std::vector<std::uint32_t> lamps;  ///< 10,100 to 12,100 lm/m^2, warm to cool white.
    std::uint32_t metal = 0, lacquer = 0, plastic = 0, screen = 0, cardboard = 0;
};

Palette add_palette(Scene& scene);

Finish draw_finish(const Palette& palette, RandomSequence& random);

}  // namespace interflect::detail::building
