#pragma once

#include "interflect/core.h"

namespace interflect::detail {

// Curves for exposed values >= 0, before clipping (docs/light/tone-mapping.md).

/// Reinhard et al. 2002, Eq. 4. Luminance 4 becomes white.
Rgb reinhard_curve(const Rgb& v);

/// Narkowicz, 'ACES Filmic Tone Mapping Curve', 2015, with input scaled to keep 0.18 at 0.18.
Rgb filmic_curve(const Rgb& v);

/// AgX of Sobotka, with the primaries of Wrensch, 'Minimal AgX Implementation', 2023.
Rgb agx_curve(const Rgb& v);

}  // namespace interflect::detail
