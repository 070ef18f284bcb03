#pragma once

#include <vector>

#include "interflect/core.h"

namespace interflect::detail {

struct SphereNode {
    V3f direction;
    float weight;  ///< [sr]
};

/// Returns 2 rows^2 nodes: Gauss-Legendre nodes in the polar cosine, times equal steps of azimuth. The quadrature is
/// exact for spherical harmonics of degree below 2 rows.
std::vector<SphereNode> sphere_quadrature(int rows);

}  // namespace interflect::detail
