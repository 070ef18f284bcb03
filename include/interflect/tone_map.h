#pragma once

#include "interflect/image.h"

namespace interflect {

/// How luminance becomes what a display shows, in [0, 1]. All rise with luminance and keep black.
///
/// The first four are curves for values that an exposure has brought to about 1; the unit of the picture does not
/// matter to them. The last three were made for one observer before the scene and another before the display: they
/// need luminances in cd/m^2, choose the brightness themselves from the luminance that the eye is adapted to, L_wa, and
/// so show a dim scene dim. L_wa is the logarithmic mean of luminance, of the same pixels as in automatic_exposure().
enum class Tonemap {
    srgb,      ///< Clipped at 1, true ratios below: what an sRGB display makes of the light itself.
    reinhard,  ///< On luminance, so that hues stay; 4 becomes white (Eq. 4 of Reinhard et al. 2002).
    filmic,    ///< Narkowicz's fit of the ACES response, a channel at a time; keeps mid-grey 0.18, 10 becomes white.
    agx,       ///< Sobotka's AgX: bright colours pale as on film; 0.18 becomes 0.22, 6.5 stops more become white.
    ward,      ///< One factor, which keeps just visible contrasts just visible (Ward 1994).
    tumblin,   ///< Keeps brightness by Stevens' law (Tumblin and Rushmeier 1993, as revised by Tumblin et al. 1999).
    ferwerda,  ///< Thresholds of cones and rods; colours fade below 20 cd/m^2 (Ferwerda et al. 1996, without acuity).
};

/// Whether an operator needs luminances in cd/m^2 and those of a display, and chooses the brightness itself.
constexpr bool is_absolute(Tonemap curve) { return curve >= Tonemap::ward; }

/// Of the white of an sRGB display, about [cd/m^2] (IEC 61966-2-1 has 80; most are brighter).
inline constexpr float usual_display_luminance = 100;

/// The exposure at which a lit room looks natural [stops]: the logarithmic mean of luminance becomes 0.2, near the
/// normal key of Reinhard et al. 2002. Black pixels do not count, nor do the darkest and the brightest 5% of the
/// others, so that neither the lamps in view nor the night outside decide. 0 for a picture without light. Pixels that
/// are not finite do not count.
float automatic_exposure(const Image& image);

/// A picture for a display (linear; image_files.h encodes it as sRGB), in [0, 1]. Black stays black, and a pixel that
/// is not finite stays as it is.
/// @param image     Radiance. [cd/m^2] where is_absolute(curve): a picture in W/(m^2 sr) then looks too dark.
/// @param exposure  [stops]: one more is twice as bright. Curves get values times 2^exposure, so that at 0 a luminance
///                  of 1 cd/m^2 enters as 1. Where is_absolute(curve) the result is multiplied: 0 is as published.
/// @param display_luminance  Of the display's white [cd/m^2], > 0; counts where is_absolute(curve).
/// @throws InputError for an exposure that is not finite, and a display luminance that is not finite and > 0.
Image tone_map(const Image& image, float exposure, Tonemap curve = Tonemap::srgb,
               float display_luminance = usual_display_luminance);

}  // namespace interflect
