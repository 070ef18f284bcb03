#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "interflect/audit/sampled_sources.h"
#include "interflect/leaks.h"
#include "interflect/scene/core/core.h"

namespace interflect {

using namespace detail;

namespace {

/// A scene has a leak if the share of escaping rays is between these limits. A smaller share changes the light by less
/// than its usual error. A larger share is an opening of more than 5 m^2 in a room of 100 m^2: the scene is open.
constexpr double min_leak = 1e-3, max_leak = 0.05;
/// Distance between an escaping ray and parallel test rays, relative to the scene's diagonal.
constexpr float distance_beside = 0.02f;
constexpr std::size_t rays_beside = 8;

/// Returns whether most of the rays parallel to an escaping ray hit a surface.
bool is_through_a_gap(const RayCaster& ray_caster, const Ray& ray, float distance) {
    const V3f& d = ray.direction;
    const V3f across = (std::abs(d.x) < 0.5f ? V3f(1, 0, 0) : V3f(0, 1, 0)).cross(d).normalized(),
              other = d.cross(across);
    std::array<Ray, rays_beside> beside;
    for (std::size_t i = 0; i < rays_beside; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.5f) / rays_beside;
        beside[i] = {ray.origin + distance * (std::cos(angle) * across + std::sin(angle) * other), d};
    }
    std::array<Hit, rays_beside> hits;
    ray_caster.trace(beside, hits);
    return 2 * std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.patch != none; }) >
           static_cast<std::ptrdiff_t>(rays_beside);
}

}  // namespace

bool Escapes::is_leak() const { return share() > min_leak && share() < max_leak && 2 * through_gaps > escaped; }

Escapes find_escapes(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    const float distance = distance_beside * core_bounds(scene).size().length();
    Escapes escapes;
    PointBlock points;
    for (const ElementIndex leaf : sample_sources(scene, ray_caster, solution).leaves) {
        const auto sample = static_cast<std::uint64_t>(escapes.rays++);
        const Ray ray = ray_from(leaf, *solution.forest, ray_caster, sample, points);
        Hit hit;
        ray_caster.trace({&ray, 1}, {&hit, 1});
        if (hit.patch != none) continue;
        ++escapes.escaped;
        escapes.through_gaps += is_through_a_gap(ray_caster, ray, distance);
    }
    return escapes;
}

}  // namespace interflect
