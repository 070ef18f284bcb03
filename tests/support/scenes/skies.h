#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "interflect/scene.h"
#include "tests/support/form_factors.h"

namespace interflect::testing_support {

/// A sky and its radiance towards it, red channel, from an independent formula.
struct KnownSky {
    std::string name;
    Luminaire luminaire;
    std::function<double(const V3d&)> radiance;
    std::function<double(const V3d&)> irradiance;  ///< On an unobstructed plane with this normal.
};
inline void PrintTo(const KnownSky& sky, std::ostream* out) { *out << sky.name; }

/// Returns CIE skies of several types, with and without a ground, including a sky with its zenith along y; maps of few
/// and many texels, some of them turned.
std::vector<KnownSky> known_skies();

/// A texture of these texels.
std::shared_ptr<const Texture> image_of(std::uint32_t width, std::uint32_t height, std::vector<Rgb> texels);

/// Computes the integral of radiance times cosine over the hemisphere of a normal, by the midpoint rule. The error is
/// about 1e-4 for smooth skies and a few percent for maps.
double irradiance_of(const std::function<double(const V3d&)>& radiance, const V3d& normal);

}  // namespace interflect::testing_support
