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

/// Somebody who looks.
struct Observer {
    Imath::V3d eye{0, 0, 0};     ///< World coordinates [m].
    V3f line_of_sight{1, 0, 0};  ///< Need not be normalised.
};

/// What an observer sees of a source of light: all emitting patches of an object, or a measured luminaire.
struct GlareSource {
    std::string name;           ///< Of the object or the luminaire; of patches in no object that of the material.
    double luminance = 0;       ///< Mean over what is seen [cd/m^2].
    double solid_angle = 0;     ///< Omega of what is seen [sr].
    double position_index = 1;  ///< p, likewise: so that L^2 omega / p^2 is `glare` for even luminance.
    double glare = 0;           ///< Integral of L^2 / p^2 over the solid angle [cd^2 sr / m^4].
};

/// Unified Glare Rating of what an observer sees.
struct GlareRating {
    double ugr = -std::numeric_limits<double>::infinity();  ///< Minus infinity where no source is seen.
    double standard_error = 0;                              ///< Of `ugr`, from that of the background.
    double background_luminance = 0;                        ///< Lb [cd/m^2].
    std::vector<GlareSource> sources{};                     ///< Those that are seen, the most glaring first.
};

/// Position index p of Guth, as fitted by Levin (1975): 1 on the line of sight, larger further from it. Below the line
/// of sight it is that of the same place above.
/// @param towards        The source. @param line_of_sight, up  Up need not be at a right angle to the line of sight.
/// None need be normalised.
/// @return  Infinity for what is not in front of the observer.
double position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up = V3f(0, 0, 1));

/// UGR = 8 log10(0.25 / Lb * sum of L^2 omega / p^2) (CIE 117:1995).
/// @param background_luminance  Lb [cd/m^2]; infinity is returned where it is 0 but sources are seen.
double unified_glare_rating(double background_luminance, std::span<const GlareSource> sources);

/// The sources that an observer sees, by quadrature over their areas with a ray to each place: emitting patches with
/// L = M / pi, and measured luminaires with L = I(d) / A(d), where A is the projected area of their luminous opening.
/// Point and spot lights and luminaires without an opening have no area and are left out, as are the sun and skies.
/// Windows that emit are sources like others, though UGR was not made for them. The z axis is up.
/// @param ray_caster  Of the same scene. Cost: 4 to 256 rays an emitting patch, 64 a luminaire.
/// @throws InputError for a line of sight without direction.
std::vector<GlareSource> glare_sources(const Scene& scene, const RayCaster& ray_caster, const Observer& observer);

/// Rates what each observer sees. Lb is the indirect illuminance of a plane at the eye that faces along the line of
/// sight, over pi.
/// @param solution  As in measure_irradiance(), as are `options` and `monitor`. Only those observers are rated that an
///                  interrupted measurement has reached; the others have a standard error that is not finite.
std::vector<GlareRating> rate_glare(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                    std::span<const Observer> observers, const PathOptions& options = {},
                                    const PathMonitor& monitor = {});

}  // namespace interflect
