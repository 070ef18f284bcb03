#pragma once

#include <span>

#include "interflect/core.h"

namespace interflect::detail {

/// CIE 1931 (x, y), negative for some spectra. Default: illuminant E, MGF's neutral.
struct Chromaticity {
    double x = 1.0 / 3, y = 1.0 / 3;
};

/// Integrates a spectrum from 380 to 780 nm, linear between values, else 0.
/// @param first, last  Wavelengths [nm], ascending.
/// @param values  At least two, at equal steps; may be negative.
/// @throws std::invalid_argument also if the luminance or X + Y + Z is 0.
Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values);

/// @param kelvin  Colour temperature, at least 1000. @throws std::invalid_argument
Chromaticity chromaticity_of_black_body(double kelvin);

struct MixedColour {
    double weight = 0;  ///< Share of luminance; may be negative.
    Chromaticity colour;
};

/// Mixes colours by luminance. @throws std::invalid_argument unless the sum of weights is positive.
Chromaticity mix(std::span<const MixedColour> parts);

/// Largest reflectance. It is below 1, where interreflection would not end.
inline constexpr double largest_reflectance = 0.99;

struct Rec709Colour {
    Rgb rgb{0, 0, 0};
    bool out_of_gamut = false;  ///< Whether the colour was outside the gamut, and is desaturated.
    bool too_bright = false;    ///< Whether the colour is desaturated or darkened to `largest`.
};

/// Converts to linear Rec. 709 with white D65 (0.3127, 0.3290). The linear Bradford transform (Lam 1985) at Y = 1 makes
/// illuminant E neutral: XYZ' = B^-1 diag(B W_D65 / B W_E) B XYZ, W_E = (1, 1, 1).
/// Mixes colours outside [0, largest] with neutral, so luminance(rgb) == min(luminance, largest).
/// @param luminance  Reflectance, or exitance [lm/m^2]; >= 0.
/// @param largest  largest_reflectance; infinite for exitances.
Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest);

struct LuminousColour {
    Chromaticity colour;
    double luminance = 0;
};

/// Inverts to_rec709() up to rounding. @param rgb  Finite, >= 0; black becomes neutral.
LuminousColour from_rec709(const RgbD& rgb);

}  // namespace interflect::detail
