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
