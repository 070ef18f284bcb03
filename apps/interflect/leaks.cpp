#include "apps/interflect/leaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene/core.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/ray_source.h"

namespace interflect::command {

namespace {

constexpr std::int64_t rays_traced = 1 << 16;
constexpr std::uint64_t leak_seed = 1;
constexpr float least_leak = 1e-3f, most_leak = 0.05f;
/// How far the rays beside one that escapes are from it, of the scene's diagonal.
constexpr float distance_beside = 0.02f;
constexpr std::size_t rays_beside = 8;

/// Systematic samples of the patches, in proportion to the power that leaves them.
std::vector<std::uint32_t> sources(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    const Materials materials(scene, ray_caster);
    std::vector<double> cumulative;
    cumulative.reserve(scene.patches.size());
    double sum = 0;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const float b = channel_sum(materials.exitance(i) + materials.reflectance(i) * solution.irradiance[i]);
        if (std::isfinite(b)) sum += static_cast<double>(b * solution.forest->area(i));
        cumulative.push_back(sum);
    }
    std::vector<std::uint32_t> patches;
    std::uint32_t i = 0;
    for (std::int64_t k = 0; sum > 0 && k < rays_traced; ++k) {
        const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(rays_traced) * sum;
        while (cumulative[i] < at) ++i;
        patches.push_back(i);
    }
    return patches;
}

/// Whether most of the rays around a ray, parallel to it, hit something.
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

Escapes find_escapes(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    const float distance = distance_beside * core_bounds(scene).size().length();
    Escapes escapes;
    PointBlock points;
    for (const std::uint32_t patch : sources(scene, ray_caster, solution)) {
        Ray ray;
        Parameters origin;
        shoot_rays(solution.forest->geometry(patch), Cell(), ray_caster.ray_offset(patch), PointSet::random, leak_seed,
                   static_cast<std::uint64_t>(escapes.rays++), points, {&ray, 1}, {&origin, 1});
        Hit hit;
        ray_caster.trace({&ray, 1}, {&hit, 1});
        if (hit.patch != none) continue;
        ++escapes.escaped;
        escapes.through_gaps += is_through_a_gap(ray_caster, ray, distance);
    }
    return escapes;
}

bool leaks(const Escapes& escapes) {
    return escapes.share() > least_leak && escapes.share() < most_leak && 2 * escapes.through_gaps > escapes.escaped;
}

}  // namespace interflect::command
