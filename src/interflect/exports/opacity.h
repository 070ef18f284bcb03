#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

// A surface with holes (Material::transmittance_texture) as other renderers have it: opaque in part, and of some
// reflectance there. A Scene has the reflectance times the opacity.

/// 1 - transmittance, of which the channels' mean is taken.
Texture opacity_of(const Scene& scene, const Material& material);

/// The texture of the reflectance divided by the opacity; black where that is 0. White, where the material has none.
/// @param opacity  opacity_of() the material, whose size the result has.
Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity);

/// Whether a surface is all there or not at all, from point to point, as far as 8 bits tell.
bool is_mask(const Texture& opacity);

}  // namespace interflect::inline detail
