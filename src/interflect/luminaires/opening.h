#pragma once

#include "interflect/luminaire.h"

namespace interflect::inline detail {

/// A point of a luminous opening, in the luminaire's frame.
struct OpeningPoint {
    V3f position;  ///< From the opening's middle [m].
    V3f normal;    ///< Unit length, outwards; zero where the opening has no area.
};

/// A point of the surface that is seen along -d, uniform over its projection.
/// @param d  Unit direction that light leaves in. @param u, v  Uniform in (0, 1).
OpeningPoint sample_opening(const LuminousOpening& opening, const V3f& d, float u, float v);

/// Area of the opening's outline as seen along d [m^2].
float projected_area(const LuminousOpening& opening, const V3f& d);

/// The axes of the luminaire's frame in the scene, of unit length.
struct LuminaireFrame {
    V3f x, y, z;
    /// @param light  Without luminaire_fault().
    explicit LuminaireFrame(const MeasuredLight& light);
    V3f to_scene(const V3f& v) const { return x * v.x + y * v.y + z * v.z; }
    V3f to_luminaire(const V3f& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
};

}  // namespace interflect::inline detail
