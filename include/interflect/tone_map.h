#pragma once

#include "interflect/image.h"

namespace interflect {

/// How exposed values become what a display shows, in [0, 1]. Every curve rises, and leaves shadows as they are.
enum class Tonemap {
    linear,    ///< Clipped at 1: true ratios below it.
    reinhard,  ///< On luminance, so that hues stay; 4 becomes white (Eq. 4 of Reinhard et al. 2002).
    filmic,    ///< Channel by channel, after a film's response: bright colours pale. Keeps mid-grey; 6.4 becomes white.
};

/// The exposure at which a lit room looks natural [stops]: the logarithmic mean of luminance becomes 0.28, between the
/// normal and the high key of Reinhard et al. 2002, since rooms have light walls. Black pixels do not count, nor do the
/// darkest and the brightest 5% of the others, so that neither the lamps in view nor the night outside decide.
/// 0 for a picture without light. Pixels that are not finite do not count.
float automatic_exposure(const Image& image);

/// A picture for a display (linear; image_files.h encodes it as sRGB): each pixel times 2^exposure, then `curve`, in
/// [0, 1]. Black stays black, and a pixel that is not finite stays as it is.
/// @param exposure  [stops]: one more is twice as bright; at 0 a luminance of 1 cd/m^2 enters the curve as 1.
/// @throws InputError for an exposure that is not finite.
Image tone_map(const Image& image, float exposure, Tonemap curve = Tonemap::filmic);

}  // namespace interflect
