#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

// Other renderers expect holes (Material::transmittance_texture) as opacity and reflectance of the opaque part. A Scene
// stores their product as reflectance.

/// Returns 1 - transmittance, averaged over the channels.
Texture opacity_of(const Scene& scene, const Material& material);

/// Returns the reflectance texture divided by the opacity: black where that is 0, white without texture.
/// @param opacity  opacity_of() the material; determines the size of the result.
Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity);

/// Returns whether every texel is fully opaque or transparent, to 8 bits.
bool is_mask(const Texture& opacity);

}  // namespace interflect::detail
