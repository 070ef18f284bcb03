#pragma once

#include "interflect/scene.h"

namespace interflect::testing_support {

/// A closed box of 1 x 2 x 3 m, 3 x 3 patches a wall, with images laid askew. Reflectance varies, and exitance with it:
/// M(x) = (1 - rho(x)) B, so that the radiosity is B everywhere, B = M + rho B, and so is the irradiance.
Scene textured_furnace(const Rgb& radiosity);

/// Where a texture has two halves: reflectance 0 and 0.8, or exitance 0 and 100 lm/m^2.
enum class Halves { reflect, emit };

/// A room of 4 x 2 x 2 m. Its floor, one patch, is dark for x < 2 m, by a texture; a ceiling lamp hangs over the other
/// half, or there is none where the floor emits.
Scene half_dark_floor(Halves halves);
/// The same without a texture: the floor is two patches of two materials, the dark one first.
Scene half_dark_floor_of_two_patches(Halves halves);

}  // namespace interflect::testing_support
