#pragma once

#include <algorithm>

#include "interflect/formats/build/colour.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Returns whether a reflection counts as a mirror. @param roughness  Root mean square of the microfacets' slopes.
inline bool is_mirror(double specular_reflectance, double roughness) {
    constexpr double roughest = 0.02;
    return specular_reflectance > 0 && roughness <= roughest;
}

inline Material default_material() {
    Material grey;
    grey.name = "default";
    grey.reflectance = Rgb(0.5f);
    return grey;
}

/// Limits a reflectance. Returns whether it changed.
inline bool limit_reflectance(Rgb& reflectance) {
    const Rgb given = reflectance;
    for (int c = 0; c < 3; ++c) reflectance[c] = std::min(reflectance[c], static_cast<float>(largest_reflectance));
    return reflectance != given;
}

/// Limits the product of a reflectance and a texture. A reflectance of 1, which is usual, is reduced by its last bit:
/// it must be below 1 (Material). Returns whether the product changed. @param largest  Largest texel in each channel.
inline bool limit_textured_reflectance(Rgb& reflectance, const Rgb& largest) {
    constexpr float nearly_black = 1e-6f, largest_factor = 1 - 0x1p-24f;
    bool is_reduced = false;
    for (int c = 0; c < 3; ++c) {
        const float limit = static_cast<float>(largest_reflectance) / std::max(largest[c], nearly_black);
        is_reduced |= reflectance[c] > std::min(limit, 1.0f);
        reflectance[c] = std::min({reflectance[c], limit, largest_factor});
    }
    return is_reduced;
}

/// Scales transmittance and specular reflectance to conserve energy. Returns whether they changed.
inline bool limit_sum(Material& material) {
    const float straight = largest_channel(Rgb(material.transmittance + material.specular_reflectance));
    const float rest = 1 - largest_channel(material.reflectance);
    if (straight <= rest) return false;
    constexpr float above_rounding = 1 - 0x1p-20f;  // keeps the rounded sum at most 1
    material.transmittance *= rest / straight * above_rounding;
    material.specular_reflectance *= rest / straight * above_rounding;
    return true;
}

}  // namespace interflect::detail
