#pragma once

#include "interflect/colour.h"

namespace interflect::inline detail {

// Curves of tone_map.h for exposed values >= 0, before they are clipped to [0, 1].

/// Eq. 4 of Reinhard, Stark, Shirley and Ferwerda, 'Photographic Tone Reproduction for Digital Images', 2002, with
/// 4 as the luminance that becomes white.
Rgb reinhard_curve(const Rgb& v);

/// Narkowicz, 'ACES Filmic Tone Mapping Curve', 2015: a rational fit of the ACES output transform for sRGB displays.
/// Its input is scaled so that 0.18 stays 0.18.
Rgb filmic_curve(const Rgb& v);

/// AgX of Troy Sobotka, with the primaries of Benjamin Wrensch's 'Minimal AgX Implementation', 2023: primaries moved
/// towards white, the logarithm from 10 stops below to 6.5 stops above mid-grey, a sigmoid, the way back, and a
/// display's power of 2.2.
Rgb agx_curve(const Rgb& v);

}  // namespace interflect::inline detail
