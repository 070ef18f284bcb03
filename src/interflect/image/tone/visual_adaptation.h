#pragma once

#include "interflect/core.h"

namespace interflect::detail {

// Match perception of display and scene (docs/light/tone-mapping.md). `adapted` is the scene's adaptation luminance
// L_wa, `white` the display's L_dmax, both > 0 [cd/m^2]. Results are relative to white, not clipped.

/// Returns the factor from luminance to [0, 1] (Ward 1994, Graphics Gems IV).
float ward_factor(float adapted, float white);

/// Tumblin and Rushmeier 1993, with the constants of Tumblin, Hodgins and Guenter 1999.
class TumblinOperator {
  public:
    TumblinOperator(float adapted, float white);

    float operator()(float luminance) const;

  private:
    float adapted_, exponent_, scale_;
};

/// Ferwerda et al. 1996, without acuity and time course.
class FerwerdaOperator {
  public:
    /// @param rods_adapted  Scotopic, > 0.
    FerwerdaOperator(float adapted, float rods_adapted, float white);

    Rgb operator()(const Rgb& radiance) const;

  private:
    float cones_, rods_;  // factors of photopic and scotopic luminance [m^2/cd]
};

/// Just noticeable luminance differences of cones [cd/m^2] and rods [scotopic cd/m^2], Ferwerda et al. 1996.
float cone_threshold(float adapted);
float rod_threshold(float adapted);

/// Returns A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), Mannos and Sakrison 1974.
/// @param cycles_per_degree  f >= 0.
double contrast_sensitivity(double cycles_per_degree);

/// Returns the luminance for rods [scotopic cd/m^2] of a Rec. 709 radiance, by Larson et al. 1997 at the primaries.
constexpr float scotopic_luminance(const Rgb& c) { return 0.085f * c.x + 1.969f * c.y + 0.519f * c.z; }

}  // namespace interflect::detail
