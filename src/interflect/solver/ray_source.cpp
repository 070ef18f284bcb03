#include "interflect/solver/ray_source.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/points.h"
#include "interflect/geometry/tangent_frame.h"

namespace interflect::inline detail {

namespace {

struct CosSin {
    float cosine, sine;
};

/// (cos 2 pi t, sin 2 pi t) for t in [0, 1], to 3e-7. Vectorises, unlike the C library.
inline CosSin cos_sin_of_turn(float turn) {
    // Nearest quarter turn, then Taylor series on [-pi/4, pi/4].
    const float quadrant = std::floor(4 * turn + 0.5f);
    const float x = (turn - 0.25f * quadrant) * 6.283185307f, x2 = x * x;
    const float s = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040))));
    const float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    const int q = static_cast<int>(quadrant) & 3;
    const float a = (q & 1) ? s : c, b = (q & 1) ? c : s;
    return {(q == 1 || q == 2) ? -a : a, (q & 2) ? -b : b};
}

}  // namespace

void shoot_rays(const PatchGeometry& patch, const Cell& cell, float offset, PointSet set, std::uint64_t key,
                std::uint64_t first_sample, PointBlock& points, std::span<Ray> rays, std::span<Parameters> origins,
                std::span<const StartPoint> starts) {
    const V3f normal = patch.normal();
    const TangentFrame frame(normal);
    for (std::size_t begin = 0; begin < rays.size(); begin += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, rays.size() - begin);
        fill_points(set, key, first_sample + begin, count, points);
        auto& [a, b, c, d] = points.coordinate;
        for (std::size_t i = 0; i < count; ++i) {  // Malley's method: uniform on the disk, projected up
            const float radius = std::sqrt(c[i]), height = std::sqrt(1 - c[i]);
            const CosSin turn = cos_sin_of_turn(d[i]);
            rays[begin + i].direction =
                frame.s * (radius * turn.cosine) + frame.t * (radius * turn.sine) + normal * height;
        }
        for (std::size_t i = 0; i < count; ++i) {
            origins[begin + i] = starts.empty() ? patch.uniform_parameters(a[i], b[i], {cell.u, cell.v}, cell.size)
                                                : StartPoints::choose(starts, a[i]);
            rays[begin + i].origin = patch.point(origins[begin + i]) + normal * offset;
        }
    }
}

}  // namespace interflect::inline detail
