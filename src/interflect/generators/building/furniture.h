#pragma once

#include <string_view>

#include "interflect/generators/building/palette.h"
#include "interflect/generators/building/random_sequence.h"
#include "interflect/generators/building/solids.h"

namespace interflect::detail::building {

/// A kind of furniture with its accessories. In local coordinates x points right, y to the front and z up; (0, 0, 0) is
/// the middle of its back, on the floor. All parts are at least `gap` inside |x| < width / 2, 0 < y < depth, and `gap`
/// above the floor.
struct Furniture {
    std::string_view name;
    float width, depth;  ///< [m]
    float clearance;     ///< Depth of floor to keep free in front for access [m].
    void (*build)(const Solids& solids, const Palette& palette, RandomSequence& random);
};

extern const Furniture bookcase;      ///< 2 m high, five rows of books.
extern const Furniture low_bookcase;  ///< Two rows of binders.
extern const Furniture workstation;   ///< A desk against the wall, with screen, lamp and papers; an office chair.
extern const Furniture cabinet;       ///< Two doors, binders on top.
extern const Furniture table;         ///< Free-standing, with four chairs.
extern const Furniture radiator;
extern const Furniture picture;  ///< Hangs on the wall; reserves the floor below.
extern const Furniture cartons;  ///< Three, stacked at random.
extern const Furniture waste_bin;

/// Adds a flat luminaire below a ceiling, 1.2 m along x and 0.6 m along y, with an emitting underside. The origin is
/// the middle of its place on the ceiling.
void add_luminaire(const Solids& solids, const Palette& palette, RandomSequence& random);

}  // namespace interflect::detail::building
