#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

// Other renderers describe holes by opacity and the opaque part's reflectance; a Scene stores their product.

/// Returns 1 - transmittance, averaged over the channels.
Texture opacity_of(const Scene& scene, const Material& material);

/// Divides the reflectance texture by the opacity: white without texture. Texels that are transparent, to 8 bits,
/// have the mean of the neighbours that are not, which are interpolated with them; else they are black.
Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity);

/// Whether texels are fully opaque or transparent, to 8 bits.
bool is_mask(const Texture& opacity);

}  // namespace interflect::detail
