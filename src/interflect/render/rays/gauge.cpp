#include "interflect/render/rays/gauge.h"

#include <array>

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

V3f Gauge::point_on(const PatchGeometry& geometry, float u, float v) const {
    constexpr float rounding = 1e-3f;  // tolerance, relative to the sides
    const float most = rounding * spacing();
    const V3f along_u = (u - 0.5f) * side_u, along_v = (v - 0.5f) * side_v;
    Parameters p;
    for (const auto& [sign_u, sign_v] : std::array<std::array<float, 2>, 4>{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}}) {
        const V3f x = position + sign_u * along_u + sign_v * along_v;
        p = geometry.parameters_of(x);
        if ((geometry.point(p) - x).length() <= most) break;
    }
    return geometry.point(geometry.inset(p, inset));
}

}  // namespace interflect::detail
