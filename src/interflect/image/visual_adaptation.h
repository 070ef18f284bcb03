#pragma once

#include "interflect/core.h"

namespace interflect::detail {

// Operators that match the perception of an observer at the display to one in the scene. Luminances are in cd/m^2.
// `adapted` is the adaptation luminance in the scene, L_wa > 0; `white` is the display's white, L_dmax > 0.

/// G. Ward, 'A Contrast-Based Scalefactor for Luminance Display', Graphics Gems IV, 1994.
/// @return  Factor from luminance to [0, 1], 1 being white [m^2/cd]. The display's observer is adapted to white / 2.
float ward_factor(float adapted, float white);

/// Tumblin and Rushmeier, 'Tone Reproduction for Realistic Images', 1993, with the equations and constants of Tumblin,
/// Hodgins and Guenter, 'Two Methods for Display of High Contrast Images', 1999. The display has a contrast of 100; its
/// observer is adapted to the middle of its range, white / sqrt(100).
class TumblinOperator {
  public:
    TumblinOperator(float adapted, float white);

    /// Returns the display's luminance relative to white; not clipped.
    float operator()(float luminance) const;

  private:
    float adapted_, exponent_, scale_;
};

/// Ferwerda, Pattanaik, Shirley and Greenberg, 'A Model of Visual Adaptation for Realistic Image Synthesis', 1996:
/// cones preserve colour, rods add grey in dark scenes. Loss of acuity and the time course of adaptation are not
/// modelled. The display's observer is adapted to white / 2.
class FerwerdaOperator {
  public:
    /// @param rods_adapted  Scotopic adaptation luminance of the rods, > 0; see scotopic_luminance().
    FerwerdaOperator(float adapted, float rods_adapted, float white);

    /// Returns the displayed colour relative to white; not clipped.
    Rgb operator()(const Rgb& radiance) const;

  private:
    float cones_, rods_;  // factors of photopic and scotopic luminance [m^2/cd]
};

/// Just noticeable luminance difference at an adaptation luminance, of cones [cd/m^2] and rods [scotopic cd/m^2]: fits
/// of Ferwerda et al. 1996.
float cone_threshold(float adapted);
float rod_threshold(float adapted);

/// Returns the scotopic luminance of a Rec. 709 radiance [scotopic cd/m^2]: the approximation Y (1.33 (1 + (Y + Z) / X)
/// - 1.68) of Larson, Rushmeier and Piatko 1997 at the three primaries. The weights also hold for white.
constexpr float scotopic_luminance(const Rgb& c) { return 0.085f * c.x + 1.969f * c.y + 0.519f * c.z; }

}  // namespace interflect::detail
