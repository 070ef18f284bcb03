#pragma once

#include "interflect/light_sources.h"

namespace interflect::detail {

struct OpeningPoint {
    V3f position;  ///< From the opening's centre [m].
    V3f normal;    ///< Outwards, unit length; zero without area.
};

/// Samples the surface visible along -d, uniformly in projection.
/// @param d     Unit direction of emission.
/// @param u, v  In (0, 1).
OpeningPoint sample_opening(const LuminousOpening& opening, const V3f& d, float u, float v);

/// Returns the area of the opening, projected along a unit direction [m^2].
float projected_area(const LuminousOpening& opening, const V3f& d);

/// Axes of the luminaire's frame, as unit vectors in the scene.
struct LuminaireFrame {
    V3f x, y, z;
    /// @param light  Without luminaire_fault().
    explicit LuminaireFrame(const MeasuredLight& light);
    V3f to_scene(const V3f& v) const { return x * v.x + y * v.y + z * v.z; }
    V3f to_luminaire(const V3f& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
};

}  // namespace interflect::detail
