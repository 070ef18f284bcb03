#pragma once

#include "interflect/colour.h"

namespace interflect::inline detail {

// Operators that match what an observer before the display sees to what one in the scene sees. Luminances are in
// cd/m^2; `adapted` is the one that the eye in the scene is adapted to, L_wa > 0, and `white` that of the display's
// white, L_dmax > 0.

/// G. Ward, 'A Contrast-Based Scalefactor for Luminance Display', Graphics Gems IV, 1994.
/// @return  What luminance is multiplied by for a value in [0, 1], 1 being the display's white [m^2/cd]. The observer
///          before the display is adapted to white / 2.
float ward_factor(float adapted, float white);

/// Tumblin and Rushmeier, 'Tone Reproduction for Realistic Images', 1993, with the equations and constants of Tumblin,
/// Hodgins and Guenter, 'Two Methods for Display of High Contrast Images', 1999. The display has a contrast of 100, and
/// its observer is adapted to the middle of its range, white / sqrt(100).
class TumblinOperator {
  public:
    TumblinOperator(float adapted, float white);

    /// The display's luminance over that of white for a luminance >= 0; not clipped.
    float operator()(float luminance) const;

  private:
    float adapted_, exponent_, scale_;
};

/// Ferwerda, Pattanaik, Shirley and Greenberg, 'A Model of Visual Adaptation for Realistic Image Synthesis', 1996:
/// cones keep colour, rods add grey as the scene gets dark. Loss of acuity and the course of adaptation are not
/// modelled. The observer before the display is adapted to white / 2.
class FerwerdaOperator {
  public:
    /// @param rods_adapted  The scotopic luminance that the rods are adapted to, > 0; see scotopic_luminance().
    FerwerdaOperator(float adapted, float rods_adapted, float white);

    /// 1 is the display's white; not clipped.
    Rgb operator()(const Rgb& radiance) const;

  private:
    float cones_, rods_;  // what photopic and scotopic luminance are multiplied by [m^2/cd]
};

/// Just noticeable difference of luminance at an adaptation, of cones [cd/m^2] and of rods [scotopic cd/m^2]: the fits
/// of Ferwerda et al. 1996.
float cone_threshold(float adapted);
float rod_threshold(float adapted);

/// [scotopic cd/m^2], from the radiance of a Rec. 709 colour: the approximation from X, Y and Z of Larson, Rushmeier
/// and Piatko 1997, Y (1.33 (1 + (Y + Z) / X) - 1.68), at the three primaries; with these weights it holds for white
/// too.
constexpr float scotopic_luminance(const Rgb& c) { return 0.085f * c.x + 1.969f * c.y + 0.519f * c.z; }

}  // namespace interflect::inline detail
