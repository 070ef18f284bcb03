#pragma once

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Point of a luminous opening in the luminaire's frame.
struct OpeningPoint {
    V3f position;  ///< From the centre of the opening [m].
    V3f normal;    ///< Unit length, outwards; zero if the opening has no area.
};

/// Samples a point of the surface visible along -d, uniformly over its projection.
/// @param d  Unit direction of the emitted light. @param u, v  Uniform in (0, 1).
OpeningPoint sample_opening(const LuminousOpening& opening, const V3f& d, float u, float v);

/// Returns the area of the opening projected along d [m^2].
float projected_area(const LuminousOpening& opening, const V3f& d);

/// Unit axes of the luminaire's frame in the scene.
struct LuminaireFrame {
    V3f x, y, z;
    /// @param light  Must not have a luminaire_fault().
    explicit LuminaireFrame(const MeasuredLight& light);
    V3f to_scene(const V3f& v) const { return x * v.x + y * v.y + z * v.z; }
    V3f to_luminaire(const V3f& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
};

}  // namespace interflect::detail
