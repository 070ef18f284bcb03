#include "interflect/checks/measuring_places.h"

#include <algorithm>
#include <cmath>

#include "interflect/checks/one_way.h"
#include "interflect/checks/shell.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_points = 2048;
constexpr std::uint64_t rays_per_point = 32, seed_of_points = 41;

float offset_of_points(const Scene& scene) {
    constexpr float relative_offset = 0x1p-17f;  // as in measure_irradiance() for points within the scene
    float reach = 0;
    for (const V3f& x : scene.vertices)
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(x[k]));
    return relative_offset * reach;
}

}  // namespace

std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points) {
    const SightLines lines(scene, ray_caster);
    const bool is_room = find_shell(scene, ray_caster, lines).is_room;
    const float offset = offset_of_points(scene);
    std::vector<PointFault> faults(points.size(), PointFault::none);
    const std::size_t step = (points.size() + max_points - 1) / max_points;
    for (std::size_t p = 0; p < points.size(); p += step) {
        const MeasuringPoint& point = points[p];
        const bool is_planar = point.receiver == Receiver::planar;
        const V3f position(point.position - scene.origin);
        const V3f normal = is_planar ? point.normal.normalized() : V3f(0);
        std::uint64_t escaped = 0, met = 0, behind = 0;
        for (std::uint64_t i = 0; i < rays_per_point; ++i) {
            V3f direction = SightLines::uniform_direction(seed_of_points, i);
            if (is_planar && direction.dot(normal) < 0) direction = -direction;
            const Ray ray{position + offset * normal, direction};
            escaped += lines.first_surface(ray).patch == none;
            Hit hit;
            ray_caster.trace({&ray, 1}, {&hit, 1});
            if (hit.patch == none) continue;
            ++met;
            behind += is_one_way(scene, ray_caster, ray, hit);
        }
        if (is_room && 4 * escaped >= rays_per_point)
            faults[p] = PointFault::outside;
        else if (2 * behind > met)
            faults[p] = PointFault::behind;
    }
    return faults;
}

}  // namespace interflect::detail
