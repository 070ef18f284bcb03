#pragma once

#include <vector>

#include "interflect/core.h"

namespace interflect::detail {

struct SphereNode {
    V3f direction;
    float weight;  ///< [sr]
};

/// 2 rows^2 nodes: Gauss-Legendre in the polar cosine, equal azimuths. Exact for spherical harmonics below degree 2
/// rows.
std::vector<SphereNode> sphere_quadrature(int rows);

}  // namespace interflect::detail
