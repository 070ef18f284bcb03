#include "tests/support/scenes/skies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

namespace interflect::testing_support {

namespace {

using std::numbers::pi;

/// 30 degrees above the horizon, south-east.
const V3d sun = V3d(std::sqrt(0.375), -std::sqrt(0.375), 0.5);
constexpr float illuminance = 9000;

SkyDome dome(int type, const V3f& zenith = {0, 0, 1}, const V3f& towards_sun = V3f(sun), float ground = 0) {
    return {cie_standard_sky(type), {illuminance, 8000, 7000}, zenith, towards_sun, ground};
}

/// Scales a sky to cause `illuminance` on a horizontal surface; `ground` below the horizon. The factor, a long sum, is
/// computed on first use, because each test makes all skies but few use them.
std::function<double(const V3d&)> scaled(const std::function<double(const V3d&)>& relative, const V3d& zenith,
                                         double ground = 0) {
    const auto of_sky = [=](const V3d& d) { return d.dot(zenith) > 0 ? relative(d) : 0; };
    const auto factor = std::make_shared<std::optional<double>>();
    return [=](const V3d& d) {
        if (!*factor) *factor = static_cast<double>(illuminance) / irradiance_of(of_sky, zenith);
        return d.dot(zenith) > 0 ? **factor * relative(d) : ground;
    };
}

double chi(const V3d& d) { return std::acos(std::clamp(d.dot(sun), -1.0, 1.0)); }

/// Type 12 of ISO 15469.
double clear(const V3d& d) {
    return (1 - std::exp(-0.32 / d.z)) *
           (1 + 10 * (std::exp(-3 * chi(d)) - std::exp(-3 * pi / 2)) + 0.45 * std::pow(d.dot(sun), 2));
}

/// Traditional overcast.
std::function<double(const V3d&)> overcast(const V3d& zenith) {
    return [zenith](const V3d& d) { return (1 + 2 * d.dot(zenith)) / 3; };
}

/// Returns the texel in a direction, by the definition of EnvironmentMap, with north turned by an angle from y towards
/// x.
std::function<double(const V3d&)> texel_seen(const std::shared_ptr<const Texture>& image, double turn, double factor) {
    return [=](const V3d& d) {
        const double azimuth = std::atan2(d.x, d.y) - turn, turns = azimuth / (2 * pi) + 0.5 + 2;
        const auto column = static_cast<std::size_t>((turns - std::floor(turns)) * image->width) % image->width;
        const auto row = std::min<std::size_t>(
            image->height - 1, static_cast<std::size_t>(std::acos(std::clamp(d.z, -1.0, 1.0)) / pi * image->height));
        return factor * static_cast<double>(image->texels[row * image->width + column].x);
    };
}

/// Computes the irradiance of an unobstructed plane under such a map, by the midpoint rule within each texel.
std::function<double(const V3d&)> under_map(const std::shared_ptr<const Texture>& image, double turn, double factor) {
    return [=](const V3d& normal) {
        const std::uint32_t parts = 1 + 400 / image->width;  // per texel and direction
        double sum = 0;
        for (std::uint32_t row = 0; row < image->height * parts; ++row) {
            const double step = pi / (image->height * parts), upper = std::cos(row * step),
                         lower = std::cos((row + 1) * step), z = (upper + lower) / 2, sine = std::sqrt(1 - z * z);
            for (std::uint32_t column = 0; column < image->width * parts; ++column) {
                const double azimuth = turn - pi + 2 * pi * (column + 0.5) / (image->width * parts);
                const V3d d(sine * std::sin(azimuth), sine * std::cos(azimuth), z);
                sum += static_cast<double>(image->texels[row / parts * image->width + column / parts].x) *
                       std::max(0.0, d.dot(normal)) * (upper - lower);
            }
        }
        return factor * sum * 2 * pi / (image->width * parts);
    };
}

KnownSky map_of(const std::string& name, const std::shared_ptr<const Texture>& image, double turn) {
    const V3f north(static_cast<float>(std::sin(turn)), static_cast<float>(std::cos(turn)), 0);
    return {name,
            {name, 0, EnvironmentMap{image, {0, 0, 1}, north, {2, 1, 3}}},
            texel_seen(image, turn, 2),
            under_map(image, turn, 2)};
}

std::shared_ptr<const Texture> uneven_image(std::uint32_t width, std::uint32_t height) {
    std::vector<Rgb> texels;
    for (std::uint32_t i = 0; i < width * height; ++i)
        texels.emplace_back(static_cast<float>(i * 7919 % 101), static_cast<float>(i * 104729 % 53), 20);
    texels[width * height / 3] = Rgb(20'000, 15'000, 10'000);
    return image_of(width, height, std::move(texels));
}

}  // namespace

std::shared_ptr<const Texture> image_of(std::uint32_t width, std::uint32_t height, std::vector<Rgb> texels) {
    return std::make_shared<Texture>(Texture{"map", width, height, std::move(texels)});
}

double irradiance_of(const std::function<double(const V3d&)>& radiance, const V3d& normal) {
    constexpr int rows = 700, columns = 1400;
    const V3d side = std::abs(normal.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    const V3d s = normal.cross(side).normalized(), t = normal.cross(s);
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double square = (i + 0.5) / rows, height = std::sqrt(1 - square), radius = std::sqrt(square);
        for (int k = 0; k < columns; ++k) {
            const double angle = 2 * pi * (k + 0.5) / columns;
            sum += radiance(s * (radius * std::cos(angle)) + t * (radius * std::sin(angle)) + normal * height);
        }
    }
    return pi * sum / (static_cast<double>(rows) * columns);
}

std::vector<KnownSky> known_skies() {
    const V3d z(0, 0, 1), y(0, 1, 0);
    const auto few =
        image_of(4, 2, {{5, 1, 0}, {9, 1, 0}, {2, 5, 0}, {0, 3, 0}, {1, 0, 0}, {0, 0, 1}, {3, 0, 2}, {7, 0, 0}});
    constexpr float ground = 0.25f;
    const auto known = [](const std::string& name, const SkyDome& sky,
                          const std::function<double(const V3d&)>& radiance) {
        return KnownSky{name, {"", 0, sky}, radiance, [=](const V3d& n) { return irradiance_of(radiance, n); }};
    };
    return {known("uniform", dome(5), [](const V3d& d) { return d.z > 0 ? double{illuminance} / pi : 0; }),
            known("overcast", dome(1), scaled([](const V3d& d) { return 1 + 4 * std::exp(-0.7 / d.z); }, z)),
            known("traditional_overcast_over_ground", dome(16, {0, 0, 2}, {0, 0, 1}, ground),
                  scaled(overcast(z), z, double{ground} * double{illuminance} / pi)),
            known("overcast_towards_y", dome(16, {0, 1, 0}, {0, 1, 0}), scaled(overcast(y), y)),
            known("clear", dome(12), scaled(clear, z)),
            map_of("map_of_eight", few, 0),
            map_of("turned_map_of_eight", few, 0.6),
            map_of("map_with_a_sun", uneven_image(60, 31), 2)};
}

}  // namespace interflect::testing_support
