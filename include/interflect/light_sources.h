/// @file
/// Light sources other than surfaces: points, spots, the sun, skies, measured luminaires; models of daylight.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "interflect/core.h"

namespace interflect {

struct Texture;

/// Relative luminance of a sky: the CIE standard general sky (CIE S 011:2003, ISO 15469:2004),
///     L(Z, chi) ~ phi(Z) f(chi),   phi(Z) = 1 + a exp(b / cos Z) + g cos Z,
///     f(chi) = 1 + c (exp(d chi) - exp(d pi / 2)) + e cos^2 chi,
/// with Z the angle from the zenith, up to 90 degrees, and chi the angle from the centre of the sun. The standard has
/// no g; a = 0, g = 2 is the traditional overcast sky (Moon and Spencer 1942).
struct SkyModel {
    float a = 0, b = -1, c = 0, d = -1, e = 0, g = 0;

    bool depends_on_sun() const { return c != 0 || e != 0; }
    /// Returns phi(Z) f(chi) for cos Z >= 0; negative factors are clamped to 0. @param sun_cosine  Value of cos chi.
    double relative_luminance(double zenith_cosine, double sun_cosine) const;
    /// Returns the integral of relative_luminance() cos Z over the upper hemisphere, which is the relative horizontal
    /// illuminance. It is accurate to five digits and takes a few milliseconds.
    /// @param sun_cosine  Cosine of the angle between zenith and sun.
    double horizontal_integral(double sun_cosine) const;
};

/// Returns a type of the standard: for example, 1 is steep overcast, 5 uniform, 7 partly cloudy, 12 clear with low
/// turbidity. Type 16 is the traditional overcast sky: L(Z) = (1 + 2 cos Z) / 3 times the zenith luminance.
/// @param type  1 to 16, otherwise InputError.
SkyModel cie_standard_sky(int type);

/// Returns the type of a named sky: "overcast" (1), "uniform" (5), "intermediate" (7), "clear" (12) or "cie-1" to
/// "cie-16"; 0 for any other name.
int cie_sky_type(std::string_view name);

/// Fault of a model, in words without a subject; empty if valid. The luminance must be finite and not 0 everywhere.
std::string sky_fault(const SkyModel& model);

/// Sky and sun from a model of daylight.
struct ModelledDaylight {
    SkyModel model;
    double sky_illuminance = 0;  ///< Horizontal illuminance from the sky alone [lx].
    double sun_illuminance = 0;  ///< Illuminance of a surface facing the sun [lx].
};
/// All-weather model: sky luminance by Perez, Seals and Michalsky 1993, efficacies by Perez et al. 1990 with 2 cm of
/// precipitable water, air mass by Kasten and Young 1989, solar constant 1367 W/m^2. The model's f(chi) = 1 + c exp(d
/// chi) + e cos^2 chi is SkyModel with c and e divided by 1 + c exp(d pi / 2). For a clearness from 1.065 to 2.8 the
/// brightness is at least 0.2, as in Radiance's gendaylit.
/// @param direct_normal, diffuse_horizontal  Irradiances [W/m^2], >= 0 and > 0, at most the solar constant.
/// @param sun_altitude  [degrees], in (0, 90].
/// @throws InputError for arguments out of range.
ModelledDaylight perez_daylight(double direct_normal, double diffuse_horizontal, double sun_altitude);

/// Luminous surface of a luminaire, centred at its photometric centre. All of its points emit equally.
struct LuminousOpening {
    enum class Shape { box, cylinder, ellipsoid };
    Shape shape = Shape::box;
    V3f size{0, 0, 0};  ///< Along x, y and z of PhotometricWeb [m]; a box of size 0 is a point, a flat one a rectangle.
    int axis = 2;       ///< Axis of a cylinder, 0 to 2; a cylinder of length 0 is a disk.

    bool is_point() const { return size == V3f(0); }
    /// Distance of the middle from a ceiling at which the opening is mounted by its top [m]. The gap of 1 mm lets light
    /// from the top reach the ceiling.
    float mounting_depth() const { return size.z / 2 + 1e-3f; }
};

/// Far-field luminous intensity of a luminaire as a function of direction (IES LM-63, EULUMDAT).
///
/// Directions are in the luminaire's frame: -z is the nadir, with vertical angle 0 in type C photometry; x is in the C0
/// half plane and y in C90, so C is counter-clockwise seen from above. Intensities are tabulated over a polar angle
/// from a pole and an azimuth about it, interpolated linearly, and zero outside the table.
struct PhotometricWeb {
    enum class Pole {
        nadir,  ///< Types C and A: the azimuth runs from x to y.
        c90     ///< Type B: the pole is y, and the azimuth runs from the nadir to x.
    };
    std::string name;  ///< Source file.
    Pole pole = Pole::nadir;
    std::vector<float> polar;        ///< [degrees], at least two, ascending within [0, 180].
    std::vector<float> azimuth;      ///< [degrees], at least two, ascending, over at most 360.
    std::vector<float> intensities;  ///< [cd] or [W/sr], >= 0: [azimuth * polar.size() + polar].
    LuminousOpening opening;
    double lamp_lumens = 0;  ///< Rated flux of the lamps for these intensities [lm]; 0: absolute photometry.

    /// Column of the table: intensities of all polar angles at one azimuth.
    const float* at_azimuth(std::size_t i) const { return intensities.data() + i * polar.size(); }
    /// Intensity in a direction of the luminaire's frame, which need not be normalised. O(log(angles)).
    float intensity(const V3f& direction) const;
    /// Integral of the intensity over all directions [lm or W], exact up to rounding. O(table).
    double flux() const;
    /// Largest intensity of the table.
    float peak() const;
};

/// Fault of a web, in words without a subject ("has ..."); empty if valid. A web without emission is invalid.
std::string web_fault(const PhotometricWeb& web);

/// Emits uniformly in all directions.
struct PointLight {
    V3f position{0, 0, 0};   ///< Relative to Scene::origin, like vertices [m].
    Rgb intensity{0, 0, 0};  ///< [lm/sr = cd, or W/sr], >= 0.
};

/// Emits into a cone, with full intensity near its axis. Between the two angles intensity is proportional to the
/// squared difference of cosines to the outer angle.
struct SpotLight {
    V3f position{0, 0, 0};    ///< Relative to Scene::origin [m].
    V3f direction{0, 0, -1};  ///< Need not be normalised.
    Rgb intensity{0, 0, 0};   ///< Intensity on the axis [lm/sr = cd, or W/sr], >= 0.
    float inner_angle = 0;    ///< Angle from the axis up to which the intensity is full [degrees], in [0, outer_angle].
    float outer_angle = 45;   ///< Angle from the axis beyond which the intensity is zero [degrees], in (0, 180].
    float inner_cosine() const;
    float outer_cosine() const;
};

/// Light from far away: parallel, or from a visible disc of uniform radiance.
struct DirectionalLight {
    V3f direction{0, 0, -1};    ///< Direction of the light; need not be normalised.
    Rgb irradiance{0, 0, 0};    ///< Irradiance of a surface perpendicular to the light [lm/m^2 or W/m^2], >= 0.
    float diameter = 0;         ///< Angular diameter of the disc [degrees]; 0: parallel light. In [0, 90].
    float disc_sine() const;    ///< Sine of the angle from the disc's centre to its edge.
    Rgb disc_radiance() const;  ///< E / (pi sin^2) with disc_sine(); only if there is a disc.
};
/// Angular diameter of the Sun at its mean distance from the Earth [degrees].
inline constexpr float sun_diameter = 0.533f;

/// Surrounds the scene with uniform radiance, also below the horizon.
struct UniformSky {
    Rgb radiance{0, 0, 0};  ///< [lm/(m^2 sr) = cd/m^2, or W/(m^2 sr)], >= 0.
};

/// A hemisphere of sky over a uniform ground, all of one colour.
struct SkyDome {
    SkyModel model;
    Rgb irradiance{0, 0, 0};  ///< Unobstructed horizontal irradiance from the sky alone [lm/m^2 or W/m^2].
    V3f zenith{0, 0, 1};      ///< Direction of the zenith; need not be normalised.
    V3f sun{0, 0, 1};         ///< Direction of the sun, not below the horizon; need not be normalised.
    /// Radiance below the horizon, times pi, over `irradiance`: the ground's reflectance if only the sky lights it.
    float ground = 0;
};

/// An image of the distant surroundings. Columns are azimuths, rows angles from the zenith, evenly spaced; texels have
/// constant radiance. The middle of the image is north, with east to the right.
struct EnvironmentMap {
    std::shared_ptr<const Texture> image;
    V3f zenith{0, 0, 1};  ///< Direction of the upper edge; need not be normalised.
    V3f north{0, 1, 0};   ///< Need not be normalised, nor perpendicular to the zenith.
    Rgb factor{1, 1, 1};  ///< Factor from texels to radiance [cd/m^2 or W/(m^2 sr)], >= 0.
};
/// Limit of texels of all environment maps of a scene: up to 24 bytes each during rendering.
inline constexpr std::uint64_t max_environment_texels = std::uint64_t{1} << 25;
/// Limit of domes and maps of a scene; each takes up to 50 MB while light is shot.
inline constexpr std::size_t max_skies = 8;

/// A luminaire with measured intensity. All points of its opening visible from a direction emit equally, so the far
/// field is as measured and the near field depends on the opening's size.
struct MeasuredLight {
    std::shared_ptr<const PhotometricWeb> web;  ///< May be shared by luminaires.
    V3f position{0, 0, 0};                      ///< Centre of the opening [m].
    V3f direction{0, 0, -1};                    ///< Nadir direction; need not be normalised.
    V3f c0{1, 0, 0};        ///< Direction in the C0 half plane; need not be perpendicular to the nadir.
    bool mirrored = false;  ///< Whether C90 is on the opposite side.
    Rgb factor{1, 1, 1};    ///< Factor of the intensities, >= 0.
};

/// A light source that is not a surface. Rays do not hit it; only skies and discs are visible.
struct Luminaire {
    std::string name;
    std::uint32_t object = 0;  ///< Index into Scene::objects.
    std::variant<PointLight, SpotLight, DirectionalLight, UniformSky, MeasuredLight, SkyDome, EnvironmentMap> kind;
};

/// Characteristic value: intensity (maximum for measured light), irradiance or radiance (maximum for a map), each in
/// its unit.
Rgb rating(const Luminaire& luminaire);

/// Returns whether a luminaire surrounds the scene: a uniform sky, a dome or a map.
bool is_sky(const Luminaire& luminaire);

/// Returns "point", "spot", "directional", "sky", "measured", "sky-dome" or "environment".
const char* kind_name(const Luminaire& luminaire);

/// Fault of a luminaire, in words without a subject; empty if valid.
std::string luminaire_fault(const Luminaire& luminaire);

}  // namespace interflect
