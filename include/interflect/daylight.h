#pragma once

#include <filesystem>
#include <optional>

#include "interflect/luminaire.h"
#include "interflect/scene.h"

namespace interflect {

/// Daylight to add to a scene. Azimuths are clockwise from north, seen from above: 90 is east. North is the world's y
/// axis, or -z if y is close to the zenith.
struct Daylight {
    struct Sun {
        double azimuth = 180, altitude = 45;  ///< Centre of the disc [degrees]; altitude in (0, 90].
        std::optional<double> illuminance{};  ///< Illuminance of a surface facing the sun [lx].
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
        double rotation = 0;         ///< Azimuth of the middle of the image [degrees].
        double scale = 1;            ///< Factor of its radiance.
    };
    std::optional<Sun> sun{};
    std::optional<CieSky> cie_sky{};
    std::optional<PerezSky> perez_sky{};  ///< Replaces cie_sky; also determines the illuminance of the sun.
    std::optional<Environment> environment{};
    double ground_reflectance = 0;  ///< Reflectance of an unobstructed ground below the horizon, lit by sky and sun.
    V3f zenith{0, 0, 1};
};

/// Default illuminances [lx] (IES RP-21, 1984; Gillette et al. 1984): horizontal, of the sky; and of a surface facing
/// the sun. With h the altitude of the sun:
///     CIE types 11 to 15, clear:            800 + 15500 sin^1/2 h,   127500 exp(-0.21 / sin h)
///     CIE types 6 to 10, partly cloudy:     300 + 45000 sin h,       127500 exp(-0.80 / sin h)
///     CIE types 1 to 5 and 16, overcast:    300 + 21000 sin h,       0
/// and 10000 for an overcast sky without a sun's altitude.
double usual_sky_illuminance(int cie_type, std::optional<double> sun_altitude);
double usual_sun_illuminance(int cie_type, double sun_altitude);

/// Adds daylight to a scene, as lights named by type and index among all lights: "sun-3", "sky-4", "environment-5".
/// Omits a sun of 0 lx. Without a sky, the default illuminance of the sun is the one for a clear sky.
/// @throws InputError for values out of range, a sky that requires a missing sun, an unreadable file, and more than
///         most_skies in the resulting scene.
void add_daylight(Scene& scene, const Daylight& added);

}  // namespace interflect
