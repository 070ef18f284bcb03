#pragma once

#include <span>

#include "interflect/colour.h"

namespace interflect::inline detail {

/// CIE 1931 chromaticity. A spectrum with negative values may have one outside the triangle x, y >= 0. The default is
/// MGF's neutral, the equal-energy spectrum (illuminant E).
struct Chromaticity {
    double x = 1.0 / 3, y = 1.0 / 3;
};

/// Computes the chromaticity of a spectrum given at equal steps of wavelength from `first` to `last` [nm]. The spectrum
/// is interpolated linearly, is zero elsewhere, and counts from 380 to 780 nm. A flat spectrum over that range gives
/// exactly neutral. Values may be negative, as in a daylight basis; only the ratio of X and Z to Y matters.
/// @param values  Two or more, in any unit.
/// @throws std::invalid_argument  if first >= last, or if the luminance or X + Y + Z is zero.
Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values);

/// Computes the chromaticity of a black body. @param kelvin  At least 1000, as in MGF; less throws
/// std::invalid_argument.
Chromaticity chromaticity_of_black_body(double kelvin);

/// Component of a mixture.
struct MixedColour {
    double weight = 0;  ///< Fraction of the luminance; need not sum to 1 and may be negative.
    Chromaticity colour;
};

/// Computes MGF's mixture. Weights are of luminance, so only the chromaticities of the parts matter.
/// @throws std::invalid_argument  if the weighted sum of luminance is not positive.
Chromaticity mix(std::span<const MixedColour> parts);

/// Upper bound of every reflectance channel read. Real files contain reflectances of 1, for which interreflection would
/// never end.
inline constexpr double largest_reflectance = 0.99;

/// Colour converted to linear Rec. 709, with the changes made to fit.
struct Rec709Colour {
    Rgb rgb{0, 0, 0};
    bool out_of_gamut = false;  ///< Chromaticity outside the triangle of Rec. 709; desaturated.
    bool too_bright = false;    ///< A channel would exceed `largest`; desaturated, then darkened if necessary.
};

/// Converts a colour to linear Rec. 709.
///
/// MGF's neutral must become R = G = B, but the white of Rec. 709 is D65 (0.3127, 0.3290). XYZ, scaled to Y = 1, is
/// therefore adapted from illuminant E to D65 with the linear Bradford transform (Lam 1985): XYZ' = B^-1 diag(B W_D65 /
/// B W_E) B XYZ, where W_E = (1, 1, 1). Then the matrix of the primaries of Rec. 709 is applied. Both steps are linear
/// and map E to (1, 1, 1).
///
/// Colours outside [0, `largest`] are mixed with the minimum amount of neutral at constant luminance. MGF gives
/// reflectance and exitance as luminous quantities (rd, ed), which interreflection must preserve. Hence luminance(rgb)
/// == min(luminance, largest), up to rounding.
/// @param luminance  rd, or ed [lm/m^2]; >= 0.
/// @param largest    Upper bound of every channel: largest_reflectance, or infinite for an exitance.
Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest);

/// Colour as in MGF.
struct LuminousColour {
    Chromaticity colour;
    double luminance = 0;
};

/// Computes the inverse of to_rec709(), up to rounding, if no channel exceeds `largest`.
/// @param rgb  Linear Rec. 709, each channel >= 0 and finite; black gets the neutral chromaticity.
LuminousColour from_rec709(const RgbD& rgb);

}  // namespace interflect::inline detail
