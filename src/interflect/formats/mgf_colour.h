#pragma once

#include <span>

#include "interflect/core.h"

namespace interflect::detail {

/// CIE 1931 chromaticity. Spectra with negative values may leave the triangle x, y >= 0. The default is MGF's neutral
/// (illuminant E).
struct Chromaticity {
    double x = 1.0 / 3, y = 1.0 / 3;
};

/// Computes the chromaticity of a spectrum with equal steps from `first` to `last` [nm], linearly interpolated and zero
/// elsewhere. Only 380 to 780 nm counts; a flat spectrum there is exactly neutral. Values may be negative, as in a
/// daylight basis, since only the ratio of X and Z to Y matters.
/// @param values  At least two, in any unit.
/// @throws std::invalid_argument  if first >= last, or if the luminance or X + Y + Z is zero.
Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values);

/// @param kelvin  At least 1000, as in MGF. @throws std::invalid_argument
Chromaticity chromaticity_of_black_body(double kelvin);

struct MixedColour {
    double weight = 0;  ///< Share of luminance; may be negative, and need not sum to 1.
    Chromaticity colour;
};

/// Computes MGF's mixture. Weights are of luminance, so only chromaticities matter. @throws std::invalid_argument  if
/// their sum is not positive.
Chromaticity mix(std::span<const MixedColour> parts);

/// Upper bound of reflectances. Real files contain 1, for which interreflection would never end.
inline constexpr double largest_reflectance = 0.99;

/// Colour in linear Rec. 709, and how it was made to fit.
struct Rec709Colour {
    Rgb rgb{0, 0, 0};
    bool out_of_gamut = false;  ///< Desaturated, since outside the triangle of Rec. 709.
    bool too_bright = false;    ///< Desaturated or darkened, since a channel would exceed `largest`.
};

/// Converts to linear Rec. 709.
///
/// MGF's neutral must become R = G = B, but Rec. 709's white is D65 (0.3127, 0.3290). XYZ at Y = 1 is therefore adapted
/// from illuminant E to D65 with the linear Bradford transform (Lam 1985): XYZ' = B^-1 diag(B W_D65 / B W_E) B XYZ, W_E
/// = (1, 1, 1). Then the matrix of the primaries is applied. Both map E to (1, 1, 1).
///
/// Colours outside [0, `largest`] are mixed with just enough neutral at constant luminance, since rd and ed are
/// luminous quantities. Hence luminance(rgb) == min(luminance, largest), up to rounding.
/// @param luminance  rd, or ed [lm/m^2]; >= 0.
/// @param largest    Bound of every channel: largest_reflectance, or infinite for an exitance.
Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest);

struct LuminousColour {
    Chromaticity colour;
    double luminance = 0;
};

/// Inverts to_rec709() up to rounding, if no channel exceeds `largest`.
/// @param rgb  Linear Rec. 709, finite, >= 0; black becomes neutral.
LuminousColour from_rec709(const RgbD& rgb);

}  // namespace interflect::detail
