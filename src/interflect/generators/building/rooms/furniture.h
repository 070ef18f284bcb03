#pragma once

#include <string_view>

#include "interflect/generators/building/plan/random_sequence.h"
#include "interflect/generators/building/walls/palette.h"
#include "interflect/generators/building/walls/solids.h"

namespace interflect::detail::building {

/// From the back, x points right, y forwards and z up; the origin is the middle of the back, on the floor. Parts are at
/// least `gap` inside |x| < width / 2, 0 < y < depth and z > 0.
struct Furniture {
    std::string_view name;
    float width, depth;  ///< [m]
    float clearance;     ///< Free floor in front [m].
    void (*build)(const Solids& solids, const Palette& palette, RandomSequence& random);
};

extern const Furniture bookcase;
extern const Furniture low_bookcase;
extern const Furniture workstation;
extern const Furniture cabinet;
extern const Furniture table;
extern const Furniture radiator;
extern const Furniture picture;  ///< Reserves the floor below.
extern const Furniture cartons;
extern const Furniture waste_bin;

/// Adds a luminaire of 1.2 m (x) by 0.6 m (y); the origin is its centre on the ceiling.
void add_luminaire(const Solids& solids, const Palette& palette, RandomSequence& random);

}  // namespace interflect::detail::building
