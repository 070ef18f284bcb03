#include "interflect/render/preview/coarse_light.h"

#include <algorithm>
#include <cmath>

#include "interflect/core.h"
#include "interflect/render/filters/surfaces.h"

namespace interflect::detail {

CoarseLight::CoarseLight(const PictureLayers& layers, const Image& picture)
    : width_(picture.width), height_(picture.height), pixels_(picture.pixels.size()) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const float spacing = layers.depth[i] * layers.pixel_angle + layers.pixel_size;
        const Rgb reflected = picture.pixels[i] - layers.emitted.pixels[i];
        if (!(layers.depth[i] > 0 && spacing > 0) || !is_finite(reflected)) continue;
        Pixel& pixel = pixels_[i];
        pixel.position = layers.position.pixels[i];
        pixel.normal = layers.normal.pixels[i];
        pixel.inverse_spacing = 1 / spacing;
        pixel.reflected = reflected;
        pixel.albedo = layers.albedo.pixels[i];
    }
}

std::optional<Rgb> CoarseLight::at(float column, float row, const V3f& x, const V3f& n) const {
    constexpr int radius = 2;             // radius of the tent filter [pixels]
    constexpr float normal_scale = 0.1f;  // squared difference of normals, about 18 degrees
    constexpr float plane_scale = 1.5f;   // height above the tangent plane, relative to the pixel spacing
    // If no pixel shows the same plane, pixels at a small height above it determine the light, else all pixels.
    constexpr float share_of_far = 0.03f, share_of_heights = 1e-3f, share_of_all = 1e-6f;
    const float first_column = std::floor(column - 0.5f) - (radius - 1),
                first_row = std::floor(row - 0.5f) - (radius - 1);
    Rgb reflected(0), albedo(0);
    float weights = 0;
    for (int v = 0; v < 2 * radius; ++v)
        for (int u = 0; u < 2 * radius; ++u) {
            const float c = first_column + static_cast<float>(u), r = first_row + static_cast<float>(v);
            const int i = static_cast<int>(c), k = static_cast<int>(r);
            if (i < 0 || k < 0 || i >= width_ || k >= height_) continue;
            const Pixel& p = pixels_[pixel_at(i, k, width_)];
            const float du = std::abs(c + 0.5f - column), dv = std::abs(r + 0.5f - row);
            const float tent =
                std::max(0.0f, 1 - du) * std::max(0.0f, 1 - dv) + share_of_far * (radius - du) * (radius - dv);
            if (p.inverse_spacing == 0 || tent <= 0) continue;
            const V3f step = p.position - x;
            const float height =
                std::max(std::abs(step.dot(n)), std::abs(step.dot(p.normal))) * p.inverse_spacing / plane_scale;
            const float height2 = height * height;
            const float weight = tent * (exp_minus((p.normal - n).length2() / normal_scale) *
                                             (exp_minus(height2) + share_of_heights / (1 + height2)) +
                                         share_of_all);
            reflected += weight * p.reflected;
            albedo += weight * p.albedo;
            weights += weight;
        }
    if (!(weights > 0)) return std::nullopt;
    // Weight pixels by their reflectance, because the light of dark pixels is uncertain.
    constexpr float darkest = 0.002f;
    Rgb light(0);
    for (int c = 0; c < 3; ++c) light[c] = std::max(0.0f, reflected[c]) / std::max(albedo[c], darkest * weights);
    return light;
}

}  // namespace interflect::detail
