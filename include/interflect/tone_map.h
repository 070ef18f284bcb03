#pragma once

#include "interflect/image.h"

namespace interflect {

/// Tone mapping operators from luminance to display values in [0, 1]. All are monotonic and preserve black.
///
/// The first four are curves for values scaled by an exposure to about 1, in any unit. The last three model an observer
/// of the scene and one of the display. They need luminances in cd/m^2 and choose the brightness from the adaptation
/// luminance L_wa, so dim scenes look dim. L_wa is the logarithmic mean of luminance, over the same pixels as in
/// automatic_exposure().
enum class Tonemap {
    srgb,      ///< Linear, clipped at 1: displays true ratios of light.
    reinhard,  ///< On luminance, which preserves hue; 4 becomes white (Eq. 4 of Reinhard et al. 2002).
    filmic,    ///< Narkowicz's fit of the ACES response, per channel; keeps mid-grey 0.18, 10 becomes white.
    agx,       ///< Sobotka's AgX: bright colours desaturate as on film; 0.18 becomes 0.22, 6.5 stops more become white.
    ward,      ///< A single factor that preserves the visibility of threshold contrasts (Ward 1994).
    tumblin,  ///< Preserves brightness by Stevens' law (Tumblin and Rushmeier 1993, as revised by Tumblin et al. 1999).
    ferwerda,  ///< Thresholds of cones and rods; colours fade below 20 cd/m^2 (Ferwerda et al. 1996, without acuity).
};

/// Whether an operator needs luminances in cd/m^2 of the scene and the display, and chooses the brightness itself.
constexpr bool is_absolute(Tonemap curve) { return curve >= Tonemap::ward; }

/// Approximate white of an sRGB display [cd/m^2] (IEC 61966-2-1 has 80; most are brighter).
inline constexpr float usual_display_luminance = 100;

/// Exposure for a natural impression of a lit room [stops]: the logarithmic mean of luminance becomes 0.2, near the
/// normal key of Reinhard et al. 2002. Ignores black and non-finite pixels, and the darkest and brightest 5% of the
/// others, to exclude visible lamps and dark windows. 0 for a picture without light.
float automatic_exposure(const Image& image);

/// Maps a picture to display values in [0, 1] (linear; image_files.h encodes it as sRGB). Black and non-finite pixels
/// are unchanged.
/// @param image     Radiance. [cd/m^2] if is_absolute(curve): a picture in W/(m^2 sr) then looks too dark.
/// @param exposure  [stops]; one more doubles the brightness. Curves receive values times 2^exposure: at 0 a luminance
///                  of 1 cd/m^2 is 1. If is_absolute(curve) the result is multiplied; 0 is as published.
/// @param display_luminance  White of the display [cd/m^2], > 0; used if is_absolute(curve).
/// @throws InputError for an exposure that is not finite, and a display luminance that is not finite and > 0.
Image tone_map(const Image& image, float exposure, Tonemap curve = Tonemap::srgb,
               float display_luminance = usual_display_luminance);

}  // namespace interflect
