#include "interflect/exports/mesh/opacity.h"

#include <algorithm>

#include "interflect/scene/texel_centre.h"

namespace interflect::detail {

Texture opacity_of(const Scene& scene, const Material& material) {
    Texture opacity = scene.textures[material.transmittance_texture];
    for (Rgb& texel : opacity.texels)
        texel = Rgb(std::clamp(1 - channel_sum(Rgb(material.transmittance * texel)) / 3, 0.0f, 1.0f));
    return opacity;
}

Texture opaque_reflectance(const Scene& scene, const Material& material, const Texture& opacity) {
    Texture reflectance{opacity.name, opacity.width, opacity.height, {}};
    for (std::size_t i = 0; i < opacity.texels.size(); ++i) {
        const float share = opacity.texels[i].x;
        if (material.reflectance_texture == none)
            reflectance.texels.emplace_back(1.0f);
        else if (!(share > 0))
            reflectance.texels.emplace_back(0.0f);
        else
            reflectance.texels.push_back(
                texel_at(scene.textures[material.reflectance_texture], texel_centre(opacity, i)) / share);
    }
    return reflectance;
}

bool is_mask(const Texture& opacity) {
    constexpr float step = 1.0f / 255;
    return std::all_of(opacity.texels.begin(), opacity.texels.end(),
                       [](const Rgb& texel) { return texel.x < step || texel.x > 1 - step; });
}

}  // namespace interflect::detail
