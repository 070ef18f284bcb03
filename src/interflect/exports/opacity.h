#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

// Converts holes of a surface (Material::transmittance_texture) for other renderers, which expect an opacity and the
// reflectance of the opaque part. A Scene stores their product as reflectance.

/// Returns 1 - transmittance, averaged over the channels.
Texture opacity_of(const Scene& scene, const Material& material);

/// Returns the reflectance texture divided by the opacity: black where the opacity is 0, white without such a texture.
/// @param opacity  opacity_of() the material; the result has its size.
Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity);

/// Returns whether every texel is fully opaque or fully transparent, to 8 bits.
bool is_mask(const Texture& opacity);

}  // namespace interflect::inline detail
