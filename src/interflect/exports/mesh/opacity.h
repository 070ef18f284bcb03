#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

// Other renderers describe holes by an opacity and the reflectance of the opaque part. A Scene stores their product.

/// Returns the opacity, which is 1 - transmittance, averaged over the channels.
Texture opacity_of(const Scene& scene, const Material& material);

/// Returns the reflectance texture over the opacity; white without a texture. Texels that are transparent, to 8 bits,
/// have the mean of their other neighbours, because renderers interpolate between them; without such neighbours they
/// are black.
Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity);

/// Returns whether all texels are fully opaque or fully transparent, to 8 bits.
bool is_mask(const Texture& opacity);

}  // namespace interflect::detail
