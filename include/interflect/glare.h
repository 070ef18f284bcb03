#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Position and gaze of an observer.
struct Observer {
    Imath::V3d eye{0, 0, 0};     ///< World coordinates [m].
    V3f line_of_sight{1, 0, 0};  ///< Need not be normalised.
};

/// Visible part of a light source: all emitting patches of an object, or a measured luminaire.
struct GlareSource {
    std::string name;           ///< Name of the object or the luminaire; for patches outside objects, of the material.
    double luminance = 0;       ///< Mean over the visible part [cd/m^2].
    double solid_angle = 0;     ///< Omega of the visible part [sr].
    double position_index = 1;  ///< Mean index p: L^2 omega / p^2 equals `glare` for uniform luminance.
    double glare = 0;           ///< Integral of L^2 / p^2 over the solid angle [cd^2 sr / m^4].
};

/// Unified Glare Rating for an observer.
struct GlareRating {
    double ugr = -std::numeric_limits<double>::infinity();  ///< Minus infinity without visible sources.
    double standard_error = 0;                              ///< Standard error of `ugr`, due to the background.
    double background_luminance = 0;                        ///< Lb [cd/m^2].
    std::vector<GlareSource> sources{};                     ///< Visible sources, in order of decreasing glare.
};

/// Position index p of Guth, as fitted by Levin (1975): 1 on the line of sight, increasing away from it; equal for
/// mirror images above and below it. Directions need not be normalised.
/// @param towards            Direction of the source.
/// @param line_of_sight, up  Need not be perpendicular.
/// @return  Infinity for directions not in front of the observer.
double position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up = V3f(0, 0, 1));

/// UGR = 8 log10(0.25 / Lb * sum of L^2 omega / p^2) (CIE 117:1995).
/// @param background_luminance  Lb [cd/m^2]; if it is 0 and sources are visible, the result is infinity.
double unified_glare_rating(double background_luminance, std::span<const GlareSource> sources);

/// Computes the visible light sources by quadrature over their areas, with a ray to each node: emitting patches with L
/// = M / pi, measured luminaires with L = I(d) / A(d), where A is the projected area of the luminous opening. Excludes
/// sources without area (point and spot lights, luminaires without opening), the sun and skies. Includes emitting
/// windows, although UGR was not designed for them. The z axis is up.
/// @param ray_caster  Of the same scene. Cost: 4 to 256 rays an emitting patch, 64 a luminaire.
/// @throws InputError for a line of sight without direction.
std::vector<GlareSource> glare_sources(const Scene& scene, const RayCaster& ray_caster, const Observer& observer);

/// Computes the glare rating of each observer. Lb is the indirect illuminance at the eye of a plane perpendicular to
/// the line of sight, over pi.
/// @param solution  As in measure_irradiance(), as are `options` and `monitor`. Observers not reached before an
///                  interruption have a non-finite standard error.
std::vector<GlareRating> rate_glare(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                    std::span<const Observer> observers, const PathOptions& options = {},
                                    const PathMonitor& monitor = {});

}  // namespace interflect
