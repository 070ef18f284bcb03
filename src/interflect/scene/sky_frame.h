#pragma once

#include "interflect/colour.h"

namespace interflect::inline detail {

/// A direction as a place in an image of all directions: `s` is the azimuth in turns, 1/2 at north and rising towards
/// east; `cosine` that of the angle from the zenith.
struct SkyPlace {
    float s, cosine;
};

/// Axes of a sky in the scene, of unit length.
struct SkyFrame {
    V3f east, north, zenith;
    /// North is towards the axis y of the scene, or -z where y is close to the zenith.
    explicit SkyFrame(const V3f& up);
    SkyFrame(const V3f& up, const V3f& towards_north);
    V3f direction(const SkyPlace& place) const;
    SkyPlace place(const V3f& direction) const;
};

}  // namespace interflect::inline detail
