#include "apps/interflect/leaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/luminaires/emission.h"
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

/// Counts the rays that do not find the way back.
class WaysBack {
  public:
    WaysBack(const Scene& scene, const RayCaster& ray_caster) : scene_(scene), ray_caster_(ray_caster) {}

    /// @param source  The patch that the ray leaves; none for a luminaire.
    void add(const Ray& ray, std::uint32_t source) {
        Hit hit, back;
        ray_caster_.trace({&ray, 1}, {&hit, 1});
        if (hit.patch == none) return;
        ++hits_;
        const float offset = ray_caster_.ray_offset(hit.patch);
        const PatchGeometry geometry(scene_, scene_.patches[hit.patch]);
        const Ray reversed{ray.origin + hit.distance * ray.direction + offset * geometry.normal(), -ray.direction};
        ray_caster_.trace({&reversed, 1}, {&back, 1});
        constexpr float rounding = 1e-4f, offsets = 8;
        const float nearest = hit.distance * (1 - rounding) - offsets * offset;
        if (back.patch == none || back.patch == source || back.distance >= nearest) return;
        ++lost_;
        const Patch& face = scene_.patches[back.patch];
        ++in_the_way_[{face.object, face.material}];
    }
    OneWayLight result() const {
        if (lost_ == 0) return {};
        const auto most = std::max_element(in_the_way_.begin(), in_the_way_.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        return {static_cast<double>(lost_) / static_cast<double>(hits_), most->first.first, most->first.second};
    }

  private:
    const Scene& scene_;
    const RayCaster& ray_caster_;
    std::int64_t hits_ = 0, lost_ = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> in_the_way_;  // by object and material
};

OneWayLight of_surfaces(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    WaysBack ways(scene, ray_caster);
    PointBlock points;
    std::uint64_t sample = 0;
    for (const std::uint32_t patch : sources(scene, ray_caster, solution)) {
        Ray ray;
        Parameters origin;
        shoot_rays(solution.forest->geometry(patch), Cell(), ray_caster.ray_offset(patch), PointSet::random, leak_seed,
                   sample++, points, {&ray, 1}, {&origin, 1});
        ways.add(ray, patch);
    }
    return ways.result();
}

/// As many rays of each part as its power asks for, rounded up.
OneWayLight of_luminaires(const Scene& scene, const RayCaster& ray_caster) {
    const Emission emission(scene);
    const double power = channel_sum(emission.total_power());
    WaysBack ways(scene, ray_caster);
    PointBlock points;
    std::vector<Ray> rays;
    for (std::size_t part = 0; part < emission.part_count(); ++part) {
        rays.resize(static_cast<std::size_t>(
            std::ceil(rays_traced * (power > 0 ? channel_sum(emission.power(part)) / power : 0))));
        emission.shoot(part, PointSet::random, leak_seed, 0, points, rays);
        for (const Ray& ray : rays) ways.add(ray, none);
    }
    return ways.result();
}

}  // namespace

OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    const bool has_one_sided_faces = std::any_of(scene.patches.begin(), scene.patches.end(),
                                                 [](const Patch& patch) { return patch.other_side == none; });
    if (!has_one_sided_faces) return {};
    const OneWayLight surfaces = of_surfaces(scene, ray_caster, solution),
                      luminaires = of_luminaires(scene, ray_caster);
    return surfaces.share > luminaires.share ? surfaces : luminaires;
}

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
