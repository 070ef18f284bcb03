#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "interflect/colour.h"
#include "interflect/photometric_web.h"

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

/// Parallel light that comes from far away, like the Sun's.
struct DirectionalLight {
    V3f direction{0, 0, -1};  ///< In which the light goes; need not be normalised.
    Rgb irradiance{0, 0, 0};  ///< Of a surface that faces it [lm/m^2 or W/m^2], >= 0.
};

/// Surrounds the scene on all sides, below its horizon too, with the same radiance.
struct UniformSky {
    Rgb radiance{0, 0, 0};  ///< [lm/(m^2 sr) = cd/m^2, or W/(m^2 sr)], >= 0.
};

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

/// A source of light that is not a surface of the scene: nothing hits it, and only a sky is seen.
struct Luminaire {
    std::string name;
    std::uint32_t object = 0;  ///< Index into Scene::objects.
    std::variant<PointLight, SpotLight, DirectionalLight, UniformSky, MeasuredLight> kind;
};

/// What it is rated by: intensity (of measured light the largest), irradiance or radiance, each in its unit.
Rgb rating(const Luminaire& luminaire);

/// "point", "spot", "directional", "sky" or "measured".
const char* kind_name(const Luminaire& luminaire);

/// What is wrong with it, in words without a subject; empty where nothing is.
std::string luminaire_fault(const Luminaire& luminaire);

}  // namespace interflect
