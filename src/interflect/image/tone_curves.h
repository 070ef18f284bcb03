#pragma once

#include "interflect/core.h"

namespace interflect::detail {

// Curves of tone_map.h for exposed values >= 0, before clipping to [0, 1].

/// Eq. 4 of Reinhard, Stark, Shirley and Ferwerda, 'Photographic Tone Reproduction for Digital Images', 2002. Luminance
/// 4 becomes white.
Rgb reinhard_curve(const Rgb& v);

/// Narkowicz, 'ACES Filmic Tone Mapping Curve', 2015: a rational fit of the ACES output transform for sRGB displays.
/// Its input is scaled to keep 0.18 at 0.18.
Rgb filmic_curve(const Rgb& v);

/// AgX of Troy Sobotka with the primaries of Benjamin Wrensch's 'Minimal AgX Implementation', 2023: primaries moved
/// towards white; logarithm from 10 stops below to 6.5 above mid-grey; sigmoid; primaries moved back; a display's power
/// of 2.2.
Rgb agx_curve(const Rgb& v);

}  // namespace interflect::detail
