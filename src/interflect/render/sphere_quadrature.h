#pragma once

#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

struct SphereNode {
    V3f direction;
    float weight;  ///< [sr]
};

/// Returns 2 rows^2 directions and weights for sums over the sphere: Gauss-Legendre nodes in the cosine of the polar
/// angle times equidistant azimuths. Exact for spherical harmonics of a degree below 2 rows.
std::vector<SphereNode> sphere_quadrature(int rows);

}  // namespace interflect::inline detail
