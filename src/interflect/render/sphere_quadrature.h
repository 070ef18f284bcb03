#pragma once

#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

struct SphereNode {
    V3f direction;
    float weight;  ///< [sr]
};

/// Returns 2 rows^2 directions and weights to integrate over the sphere: Gauss-Legendre in the polar cosine, equal
/// azimuths. Exact for spherical harmonics below degree 2 rows.
std::vector<SphereNode> sphere_quadrature(int rows);

}  // namespace interflect::detail
