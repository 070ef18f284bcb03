#pragma once

#include <filesystem>
#include <optional>

#include "interflect/luminaire.h"
#include "interflect/scene.h"

namespace interflect {

/// Daylight that is placed in a scene beside the lights of its file. Azimuths count from north, clockwise as seen from
/// above: 90 is east. North is the world's y, or -z where that is close to the zenith.
struct Daylight {
    struct Sun {
        double azimuth = 180, altitude = 45;  ///< Of the disc's centre [degrees]; altitude in (0, 90].
        std::optional<double> illuminance{};  ///< Of a surface that faces it [lx].
    };
    struct CieSky {
        int type = 1;                         ///< As cie_standard_sky().
        std::optional<double> illuminance{};  ///< Horizontal, of the sky alone [lx].
    };
    struct PerezSky {
        double direct_normal = 0, diffuse_horizontal = 0;  ///< Irradiances [W/m^2].
    };
    struct Environment {
        std::filesystem::path file;  ///< .exr or .hdr.
        double rotation = 0;         ///< Azimuth in the middle of the image [degrees].
        double scale = 1;            ///< Factor of its radiance.
    };
    std::optional<Sun> sun{};
    std::optional<CieSky> cie_sky{};
    std::optional<PerezSky> perez_sky{};  ///< In place of cie_sky; it gives the illuminance of the sun too.
    std::optional<Environment> environment{};
    double ground_reflectance = 0;  ///< Of an unobstructed ground below the horizon, lit by sky and sun.
    V3f zenith{0, 0, 1};
};

/// Horizontal illuminance of the sky, and illuminance of a surface that faces the sun, which are used where none is
/// given [lx] (IES RP-21, 1984; Gillette et al. 1984), with h the altitude of the sun:
///   CIE types 11 to 15, clear:            800 + 15500 sin^1/2 h,   127500 exp(-0.21 / sin h)
///   CIE types 6 to 10, partly cloudy:     300 + 45000 sin h,       127500 exp(-0.80 / sin h)
///   CIE types 1 to 5 and 16, overcast:    300 + 21000 sin h,       0
/// and 10000 for an overcast sky without a sun's altitude.
double usual_sky_illuminance(int cie_type, std::optional<double> sun_altitude);
double usual_sun_illuminance(int cie_type, double sun_altitude);

/// Adds it to a scene, as lights called "sun-3", "sky-4", "environment-5" after their place among all. A sun of 0 lx is
/// left out; without a sky its usual illuminance is that of a clear one.
/// @throws InputError for what is out of range, for a sky that needs a sun where there is none, for a file that
///         cannot be read, and where the scene then has more than most_skies.
void add_daylight(Scene& scene, const Daylight& added);

}  // namespace interflect
