#pragma once

#include <span>

#include "interflect/colour.h"

namespace interflect::inline detail {

/// CIE 1931 chromaticity; that of a spectrum with negative values may lie outside the triangle of x, y >= 0. The
/// default is MGF's neutral, that of a spectrum of equal energy (illuminant E).
struct Chromaticity {
    double x = 1.0 / 3, y = 1.0 / 3;
};

/// The chromaticity of a spectrum: values at equal steps of wavelength from `first` to `last` [nm], interpolated
/// linearly, zero elsewhere; only 380 to 780 nm counts. A flat spectrum over that range gives exactly neutral. Values
/// may be negative, as in a basis of which daylight is mixed: what counts is the ratio of X and Z to Y.
/// @param values  Two or more, in any unit.
/// @throws std::invalid_argument  where first >= last, or the spectrum's luminance, or X + Y + Z, is zero.
Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values);

/// The chromaticity of a black body. @param kelvin  At least 1000, as MGF has it. @throws std::invalid_argument below.
Chromaticity chromaticity_of_black_body(double kelvin);

/// One part of a mixture.
struct MixedColour {
    double weight = 0;  ///< Share of the luminance; need not sum to 1, and may be negative.
    Chromaticity colour;
};

/// MGF's mixture: weights are of luminance, whether the parts were given as spectra or chromaticities, so that only the
/// parts' chromaticities matter. @throws std::invalid_argument where their sum is not positive.
Chromaticity mix(std::span<const MixedColour> parts);

/// Bound of every channel of a reflectance that is read: interflection between surfaces that lose nothing would never
/// end, and real files do have reflectances of 1.
inline constexpr double largest_reflectance = 0.99;

/// A colour brought into linear Rec. 709, and what had to be given up for it.
struct Rec709Colour {
    Rgb rgb{0, 0, 0};
    bool out_of_gamut = false;  ///< The chromaticity lies outside Rec. 709's triangle: desaturated.
    bool too_bright = false;  ///< A channel would exceed `largest`: desaturated, or darkened where that is not enough.
};

/// Linear Rec. 709 of luminance `luminance` and the given chromaticity.
///
/// MGF's neutral must become R = G = B, but Rec. 709's white is D65 (0.3127, 0.3290). So XYZ, scaled to Y = 1, is
/// adapted from illuminant E to D65 with the linear Bradford transform (Lam 1985): XYZ' = B^-1 diag(B W_D65 / B W_E) B
/// XYZ, where W_E = (1, 1, 1); then the matrix of Rec. 709's primaries is applied. Both are linear, and E goes to (1,
/// 1, 1).
///
/// What lies outside [0, `largest`] is mixed with neutral just as far as needed, at constant luminance: MGF gives
/// reflectance and exitance as luminous quantities (rd, ed), and interflection must keep those. So always
/// luminance(rgb) == min(luminance, largest), up to rounding.
/// @param luminance  rd, or ed [lm/m^2]; >= 0.
/// @param largest    Upper bound of every channel: largest_reflectance, or infinite for an exitance.
Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest);

/// A colour as MGF gives it.
struct LuminousColour {
    Chromaticity colour;
    double luminance = 0;
};

/// The inverse: to_rec709() of what is returned gives `rgb` again, up to rounding, where no channel is above `largest`.
/// @param rgb  Linear Rec. 709, each channel >= 0 and finite; black gets the chromaticity of neutral.
LuminousColour from_rec709(const RgbD& rgb);

}  // namespace interflect::inline detail
