#include "interflect/render/rays/nearby_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace interflect::detail {

namespace {

/// Weight at a squared distance: 1 at 0, 1/16 at 1.
float falloff(float squared_distance) {
    const float t = 1 / (1 + squared_distance), t2 = t * t;
    return t2 * t2;
}

}  // namespace

NearbyLight::Found NearbyLight::at(std::uint32_t pixel, const PatchGeometry& patch) const {
    constexpr int radius = 2;              // of the neighbourhood [pixels]
    constexpr float pixel_scale = 8;       // squared distance in the picture of weight 1/16 [pixels^2]
    constexpr float normal_scale = 0.08f;  // squared difference of normals of weight 1/16: 16 degrees
    const V3f x = patch.centre(), n = patch.normal();
    const auto width = static_cast<std::uint32_t>(width_);
    const int column = static_cast<int>(pixel % width), row = static_cast<int>(pixel / width);
    Rgb reflected(0), reflectance(0);
    Found found;
    for (int k = std::max(0, row - radius); k <= std::min(height_ - 1, row + radius); ++k)
        for (int i = std::max(0, column - radius); i <= std::min(width_ - 1, column + radius); ++i) {
            if (i == column && k == row) continue;
            const auto steps2 = static_cast<float>((i - column) * (i - column) + (k - row) * (k - row));
            const float near = falloff(steps2 / pixel_scale);
            const std::size_t first = 2 * (static_cast<std::size_t>(k) * width + static_cast<std::size_t>(i));
            for (const std::size_t s : {first, first + 1}) {
                const Sample& sample = samples_[s];
                if (!(sample.spacing > 0)) continue;
                const float height = (sample.position - x).dot(n) / sample.spacing;
                const float turn2 = (sample.normal - n).length2();
                const float weight = near * falloff(height * height + turn2 / normal_scale);
                reflected += weight * sample.reflected;
                reflectance += weight * sample.reflectance;
                found.weight += weight;
            }
        }
    for (int c = 0; c < 3; ++c)
        if (reflectance[c] > 0) found.light[c] = reflected[c] / reflectance[c];
    return found;
}

const NearbyLight::Found& NearbyLightLookups::find(const NearbyLight& light, std::uint32_t pixel, PatchIndex patch,
                                                   const PatchGeometry& geometry) {
    if (pixel != pixel_) lights_.clear();
    pixel_ = pixel;
    const auto is_same = [patch](const auto& entry) { return entry.first == patch; };
    const auto found = std::find_if(lights_.begin(), lights_.end(), is_same);
    if (found != lights_.end()) return found->second;
    return lights_.emplace_back(patch, light.at(pixel, geometry)).second;
}

}  // namespace interflect::detail
