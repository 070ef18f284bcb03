#pragma once

#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

struct SphereNode {
    V3f direction;
    float weight;  ///< [sr]
};

/// Directions and weights that sum functions over the sphere: Gauss-Legendre nodes in the cosine of the polar angle
/// times equal azimuths. Exact for spherical harmonics below degree 2 rows. @return  2 rows^2 nodes.
std::vector<SphereNode> sphere_quadrature(int rows);

}  // namespace interflect::inline detail
