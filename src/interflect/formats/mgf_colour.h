#pragma once

#include <span>

#include "interflect/core.h"

namespace interflect::detail {

/// CIE 1931; negative spectra may leave x, y >= 0. The default is illuminant E, MGF's neutral.
struct Chromaticity {
    double x = 1.0 / 3, y = 1.0 / 3;
};

/// Returns the chromaticity of a spectrum that is linear between its values and 0 elsewhere. Only 380 to 780 nm counts;
/// a flat spectrum there is exactly neutral.
/// @param first, last  Wavelengths of the first and last value [nm].
/// @param values  At least two, at equal steps; may be negative, as in a daylight basis.
/// @throws std::invalid_argument if first >= last, or if the luminance or X + Y + Z is 0.
Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values);

/// @param kelvin  At least 1000, as in MGF. @throws std::invalid_argument
Chromaticity chromaticity_of_black_body(double kelvin);

struct MixedColour {
    double weight = 0;  ///< Share of luminance; may be negative.
    Chromaticity colour;
};

/// @throws std::invalid_argument unless the sum of weights is positive.
Chromaticity mix(std::span<const MixedColour> parts);

/// Upper bound. Files contain 1, for which interreflection would not end.
inline constexpr double largest_reflectance = 0.99;

struct Rec709Colour {
    Rgb rgb{0, 0, 0};
    bool out_of_gamut = false;  ///< Desaturated, since outside the triangle of Rec. 709.
    bool too_bright = false;    ///< Desaturated or darkened, since a channel would exceed `largest`.
};

/// Converts to linear Rec. 709 with white D65 (0.3127, 0.3290). MGF's neutral, illuminant E, becomes R = G = B by the
/// linear Bradford transform (Lam 1985) at Y = 1: XYZ' = B^-1 diag(B W_D65 / B W_E) B XYZ, W_E = (1, 1, 1).
///
/// Colours outside [0, largest] are mixed with neutral at constant luminance, so luminance(rgb) == min(luminance,
/// largest) up to rounding.
/// @param luminance  rd, or ed [lm/m^2]; >= 0.
/// @param largest  largest_reflectance, or infinite for an exitance.
Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest);

struct LuminousColour {
    Chromaticity colour;
    double luminance = 0;
};

/// Inverts to_rec709() up to rounding, if no channel exceeds `largest`.
/// @param rgb  Finite, >= 0; black becomes neutral.
LuminousColour from_rec709(const RgbD& rgb);

}  // namespace interflect::detail
