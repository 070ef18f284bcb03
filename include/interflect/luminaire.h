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

/// Shines alike in all directions.
struct PointLight {
    V3f position{0, 0, 0};   ///< As vertices are, relative to Scene::origin [m].
    Rgb intensity{0, 0, 0};  ///< [lm/sr = cd, or W/sr], >= 0.
};

/// Shines into a cone, with full intensity near its axis. Between the two angles intensity is in proportion to the
/// square of how far the cosine is from that of the outer one.
struct SpotLight {
    V3f position{0, 0, 0};    ///< [m]
    V3f direction{0, 0, -1};  ///< Need not be normalised.
    Rgb intensity{0, 0, 0};   ///< On the axis [lm/sr = cd, or W/sr], >= 0.
    float inner_angle = 0;    ///< From the axis [degrees]; up to there intensity is full. In [0, outer_angle].
    float outer_angle = 45;   ///< From there on it is zero. In (0, 180].
    float inner_cosine() const;
    float outer_cosine() const;
};

/// Light that comes from far away: parallel, or from a disc of uniform radiance, which pictures show.
struct DirectionalLight {
    V3f direction{0, 0, -1};    ///< In which the light goes; need not be normalised.
    Rgb irradiance{0, 0, 0};    ///< Of a surface that faces it [lm/m^2 or W/m^2], >= 0.
    float diameter = 0;         ///< Of the disc [degrees]; 0: parallel light. In [0, 90].
    float disc_sine() const;    ///< Of the angle from the disc's centre to its edge.
    Rgb disc_radiance() const;  ///< E / (pi sin^2); only with a disc.
};
/// The Sun's, at its mean distance from the Earth [degrees].
inline constexpr float sun_diameter = 0.533f;

/// Surrounds the scene on all sides, below its horizon too, with the same radiance.
struct UniformSky {
    Rgb radiance{0, 0, 0};  ///< [lm/(m^2 sr) = cd/m^2, or W/(m^2 sr)], >= 0.
};

/// A hemisphere of sky over a uniform ground that reaches to the horizon, all of one colour.
struct SkyDome {
    SkyModel model;
    Rgb irradiance{0, 0, 0};  ///< That the sky alone causes on an unobstructed horizontal surface [lm/m^2 or W/m^2].
    V3f zenith{0, 0, 1};      ///< Need not be normalised, nor need the next one.
    V3f sun{0, 0, 1};         ///< Towards the sun, not below the horizon. The sun itself is a DirectionalLight.
    /// Radiance below the horizon, times pi, over `irradiance`: where the sky alone lights the ground, its reflectance.
    float ground = 0;
};

/// An image of all that surrounds the scene, far away: columns are azimuths, rows angles from the zenith, evenly
/// spaced, and each texel is of one radiance. The middle of the image is north; east is to the right of it.
struct EnvironmentMap {
    std::shared_ptr<const Texture> image;
    V3f zenith{0, 0, 1};  ///< Direction of the upper edge; need not be normalised.
    V3f north{0, 1, 0};   ///< Need not be normalised, nor at a right angle to the zenith.
    Rgb factor{1, 1, 1};  ///< Of the texels, to radiance [cd/m^2 or W/(m^2 sr)], >= 0.
};
/// Texels of all environment maps of a scene: up to 24 bytes each while pictures are drawn.
inline constexpr std::uint64_t most_environment_texels = std::uint64_t{1} << 25;
/// Domes and maps of a scene, each of which takes up to 50 MB while light is shot.
inline constexpr std::size_t most_skies = 8;

/// A luminaire whose light was measured. Every point of its opening that a direction leaves from shines alike, so that
/// far away it is what was measured, and close by it has the opening's size.
struct MeasuredLight {
    std::shared_ptr<const PhotometricWeb> web;  ///< Many luminaires may share one.
    V3f position{0, 0, 0};                      ///< Of the opening's middle [m].
    V3f direction{0, 0, -1};                    ///< Of its nadir; need not be normalised.
    V3f c0{1, 0, 0};  ///< Its C0 half plane holds this direction, which need not be at a right angle to the nadir.
    bool mirrored = false;  ///< C90 lies on the other side.
    Rgb factor{1, 1, 1};    ///< Of the intensities, >= 0.
};

/// A source of light that is not a surface of the scene: nothing hits it, and only skies and discs are seen.
struct Luminaire {
    std::string name;
    std::uint32_t object = 0;  ///< Index into Scene::objects.
    std::variant<PointLight, SpotLight, DirectionalLight, UniformSky, MeasuredLight, SkyDome, EnvironmentMap> kind;
};

/// What it is rated by: intensity (of measured light the largest), irradiance or radiance (of a map the largest), each
/// in its unit.
Rgb rating(const Luminaire& luminaire);

/// Whether it surrounds the scene: a uniform sky, a dome or a map.
bool is_sky(const Luminaire& luminaire);

/// "point", "spot", "directional", "sky", "measured", "sky-dome" or "environment".
const char* kind_name(const Luminaire& luminaire);

/// What is wrong with it, in words without a subject; empty where nothing is.
std::string luminaire_fault(const Luminaire& luminaire);

}  // namespace interflect
