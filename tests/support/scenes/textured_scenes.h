#pragma once

#include <ostream>

#include "interflect/scene.h"

namespace interflect::testing_support {

/// Makes a closed box of 1 x 2 x 3 m, 3 x 3 patches a wall, with images laid askew. Reflectance varies, and exitance
/// M(x) = (1 - rho(x)) B with it, so that radiosity and irradiance are B everywhere.
Scene textured_furnace(const Rgb& radiosity);

/// Meaning of the two halves of a texture: reflectance 0 and 0.8, or exitance 0 and 100 lm/m^2.
enum class Halves { reflect, emit };
inline void PrintTo(Halves halves, std::ostream* out) { *out << (halves == Halves::reflect ? "reflect" : "emit"); }

/// Makes a room of 4 x 2 x 2 m. Its floor, one patch, is dark for x < 2 m, by a texture. A ceiling lamp hangs over the
/// other half, unless the floor emits.
Scene half_dark_floor(Halves halves);
/// Makes the same without a texture: the floor is two patches of two materials, the dark one first.
Scene half_dark_floor_of_two_patches(Halves halves);

}  // namespace interflect::testing_support
