#include "interflect/exports/mesh/opacity.h"

#include <algorithm>

#include "interflect/scene/faces/texel_centre.h"

namespace interflect::detail {

namespace {

constexpr float byte_step = 1.0f / 255;

bool is_transparent(const Rgb& opacity) { return opacity.x < byte_step; }

void fill_transparent_texels(Texture& reflectance, const Texture& opacity) {
    const std::uint32_t width = opacity.width, height = opacity.height;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (!is_transparent(opacity.texels[std::size_t{y} * width + x])) continue;
            Rgb sum(0);
            int count = 0;
            for (const std::uint32_t row : {y + height - 1, y, y + 1})
                for (const std::uint32_t column : {x + width - 1, x, x + 1}) {
                    const std::size_t i = std::size_t{row % height} * width + column % width;
                    if (is_transparent(opacity.texels[i])) continue;
                    sum += reflectance.texels[i];
                    ++count;
                }
            if (count > 0) reflectance.texels[std::size_t{y} * width + x] = sum / static_cast<float>(count);
        }
}

}  // namespace

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
        else if (is_transparent(Rgb(share)))
            reflectance.texels.emplace_back(0.0f);  // replaced below
        else
            reflectance.texels.push_back(
                texel_at(scene.textures[material.reflectance_texture], texel_centre(opacity, i)) / share);
    }
    if (material.reflectance_texture != none) fill_transparent_texels(reflectance, opacity);
    return reflectance;
}

bool is_mask(const Texture& opacity) {
    return std::all_of(opacity.texels.begin(), opacity.texels.end(),
                       [](const Rgb& texel) { return is_transparent(texel) || texel.x > 1 - byte_step; });
}

}  // namespace interflect::detail
