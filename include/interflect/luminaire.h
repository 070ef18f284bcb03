#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "interflect/colour.h"
#include "interflect/photometric_web.h"
#include "interflect/sky.h"
#include "interflect/texture.h"

namespace interflect {

/// Emits uniformly in all directions.
struct PointLight {
    V3f position{0, 0, 0};   ///< Relative to Scene::origin, like vertices [m].
    Rgb intensity{0, 0, 0};  ///< [lm/sr = cd, or W/sr], >= 0.
};

/// Emits into a cone, with full intensity near its axis. Between the two angles intensity is proportional to the
/// squared difference of cosines to the outer angle.
struct SpotLight {
    V3f position{0, 0, 0};    ///< [m]
    V3f direction{0, 0, -1};  ///< Need not be normalised.
    Rgb intensity{0, 0, 0};   ///< On the axis [lm/sr = cd, or W/sr], >= 0.
    float inner_angle = 0;    ///< From the axis [degrees]: full intensity up to this angle. In [0, outer_angle].
    float outer_angle = 45;   ///< Zero intensity from this angle on. In (0, 180].
    float inner_cosine() const;
    float outer_cosine() const;
};

/// Light from far away: parallel, or from a visible disc of uniform radiance.
struct DirectionalLight {
    V3f direction{0, 0, -1};    ///< Direction of the light; need not be normalised.
    Rgb irradiance{0, 0, 0};    ///< Irradiance of a surface perpendicular to the light [lm/m^2 or W/m^2], >= 0.
    float diameter = 0;         ///< Angular diameter of the disc [degrees]; 0: parallel light. In [0, 90].
    float disc_sine() const;    ///< Sine of the angle from the disc's centre to its edge.
    Rgb disc_radiance() const;  ///< E / (pi sin^2); only with a disc.
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
    Rgb irradiance{0, 0, 0};  ///< Horizontal, unobstructed, of the sky alone [lm/m^2 or W/m^2].
    V3f zenith{0, 0, 1};      ///< Need not be normalised; neither need `sun`.
    V3f sun{0, 0, 1};         ///< Towards the sun, not below the horizon. The sun itself is a DirectionalLight.
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
inline constexpr std::uint64_t most_environment_texels = std::uint64_t{1} << 25;
/// Limit of domes and maps of a scene; each takes up to 50 MB while light is shot.
inline constexpr std::size_t most_skies = 8;

/// A luminaire with measured intensity. All points of its opening visible from a direction emit equally, so the far
/// field is as measured and the near field depends on the opening's size.
struct MeasuredLight {
    std::shared_ptr<const PhotometricWeb> web;  ///< May be shared by luminaires.
    V3f position{0, 0, 0};                      ///< Centre of the opening [m].
    V3f direction{0, 0, -1};                    ///< Nadir direction; need not be normalised.
    V3f c0{1, 0, 0};        ///< Direction in the C0 half plane; need not be perpendicular to the nadir.
    bool mirrored = false;  ///< C90 is on the opposite side.
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

/// Whether it surrounds the scene: a uniform sky, a dome or a map.
bool is_sky(const Luminaire& luminaire);

/// "point", "spot", "directional", "sky", "measured", "sky-dome" or "environment".
const char* kind_name(const Luminaire& luminaire);

/// Fault of a luminaire, in words without a subject; empty if valid.
std::string luminaire_fault(const Luminaire& luminaire);

}  // namespace interflect
