#pragma once

#include "interflect/core.h"

namespace interflect::detail {

/// Position in a full-sphere image: azimuth in turns (1/2 at north, rising towards east) and cosine of the zenith
/// angle.
struct SkyPlace {
    float s, cosine;
};

struct SkyFrame {
    V3f east, north, zenith;
    /// North is the scene's y axis, or -z if y is close to the zenith.
    explicit SkyFrame(const V3f& up);
    SkyFrame(const V3f& up, const V3f& towards_north);
    V3f direction(const SkyPlace& place) const;
    SkyPlace place(const V3f& direction) const;
};

}  // namespace interflect::detail
