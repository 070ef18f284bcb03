#include "interflect/measure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "interflect/base/threads/parallel.h"
#include "interflect/checks/search/one_way.h"
#include "interflect/checks/search/shell.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene/luminaires/luminaire.h"

namespace interflect {

using namespace detail;

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

/// Start of a measuring point's rays, and the normal of their hemisphere; (0, 0, 0) for the whole sphere.
struct RayStart {
    V3f position, normal;
};

RayStart ray_start(const Scene& scene, const MeasuringPoint& point, float offset) {
    const V3f normal = point.receiver == Receiver::planar ? point.normal.normalized() : V3f(0);
    return {V3f(point.position - scene.origin) + offset * normal, normal};
}

struct FirstHits {
    std::uint64_t escaped = 0;      ///< Rays that leave the scene, perhaps through panes.
    std::uint64_t met = 0;          ///< Rays with a hit.
    std::uint64_t passed_back = 0;  ///< Rays that pass the back of a one-sided face before the hit.
    bool is_inside_solid() const { return 2 * passed_back > met; }
};

FirstHits first_hits(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines, const RayStart& start) {
    FirstHits hits;
    for (std::uint64_t i = 0; i < rays_per_point; ++i) {
        V3f direction = SightLines::uniform_direction(seed_of_points, i);
        if (direction.dot(start.normal) < 0) direction = -direction;
        const Ray ray{start.position, direction};
        hits.escaped += lines.first_surface(ray).patch == none;
        Hit hit;
        ray_caster.trace({&ray, 1}, {&hit, 1});
        if (hit.patch == none) continue;
        ++hits.met;
        hits.passed_back += is_one_way(scene, ray_caster, ray, hit);
    }
    return hits;
}

/// Finds whether light can reach a point, by random walks that every face reflects diffusely.
class LightSearch {
  public:
    LightSearch(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines)
        : scene_(scene), ray_caster_(ray_caster), lines_(lines) {
        for (const Luminaire& luminaire : scene.luminaires)
            if (const std::optional<V3f> position = position_of(luminaire)) sources_.push_back(*position);
        for (PatchIndex i{0}; i < scene.patches.size(); ++i)
            if (emits(i)) sources_.push_back(in_front_of(i, PatchGeometry(scene, scene.patches[i]).centre()));
    }

    bool reaches(const RayStart& start) const {
        constexpr std::uint64_t walks = 64, segments = 16;
        const V3f* const nearest = nearest_source(start.position);
        for (std::uint64_t walk = 0; walk < walks; ++walk) {
            V3f x = start.position, normal = start.normal;
            for (std::uint64_t segment = 0; segment < segments; ++segment) {
                const std::uint64_t index = walk * segments + segment;
                V3f direction = SightLines::uniform_direction(seed_of_points, index);
                if (direction.dot(normal) < 0) direction = -direction;
                const Hit hit = lines_.first_surface({x, direction});
                if (hit.patch == none || emits(hit.patch)) return true;
                x = in_front_of(hit.patch, x + hit.distance * direction);
                normal = PatchGeometry(scene_, scene_.patches[hit.patch]).normal();
                // Connect the walk with the nearest source and with all sources in turn.
                if (!nearest) continue;
                const V3f& source = index % 2 == 0 ? *nearest : sources_[index / 2 % sources_.size()];
                if (lines_.is_clear(x, source)) return true;
            }
        }
        return false;
    }

  private:
    bool emits(PatchIndex patch) const {
        return largest_channel(scene_.materials[scene_.patches[patch].material].exitance) > 0;
    }
    V3f in_front_of(PatchIndex patch, const V3f& x) const {
        return x + ray_caster_.ray_offset(patch) * PatchGeometry(scene_, scene_.patches[patch]).normal();
    }
    const V3f* nearest_source(const V3f& x) const {
        const auto nearest = std::min_element(sources_.begin(), sources_.end(), [&](const V3f& a, const V3f& b) {
            return (a - x).length2() < (b - x).length2();
        });
        return nearest == sources_.end() ? nullptr : &*nearest;
    }

    const Scene& scene_;
    const RayCaster& ray_caster_;
    const SightLines& lines_;
    std::vector<V3f> sources_;
};

}  // namespace

std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points) {
    const SightLines lines(scene, ray_caster);
    const bool is_room = find_shell(scene, ray_caster, lines).is_room;
    const float offset = offset_of_points(scene);
    std::vector<PointFault> faults(points.size(), PointFault::sound);
    const std::size_t step = (points.size() + max_points - 1) / max_points;
    for (std::size_t p = 0; p < points.size(); p += step) {
        const FirstHits hits = first_hits(scene, ray_caster, lines, ray_start(scene, points[p], offset));
        if (is_room && 4 * hits.escaped >= rays_per_point)
            faults[p] = PointFault::outside;
        else if (hits.is_inside_solid())
            faults[p] = PointFault::behind;
    }
    return faults;
}

MeasuringGrid without_enclosed_points(const Scene& scene, const RayCaster& ray_caster, MeasuringGrid grid) {
    ray_caster.require_made_for(scene);
    if (grid.columns == 0) return grid;
    const SightLines lines(scene, ray_caster);
    const LightSearch light(scene, ray_caster, lines);
    const float offset = offset_of_points(scene);
    std::vector<char> is_open(grid.points.size());
    parallel_for_ranges(grid.points.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const RayStart start = ray_start(scene, {grid.points[i], grid.normal}, offset);
            is_open[i] = light.reaches(start) && !first_hits(scene, ray_caster, lines, start).is_inside_solid();
        }
    });
    const auto open = static_cast<std::size_t>(std::count(is_open.begin(), is_open.end(), true));
    if (open == 0 || open == grid.points.size()) return grid;
    grid.enclosed = grid.points.size() - open;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        if (!is_open[i]) continue;
        grid.points[kept] = grid.points[i];
        grid.cells[kept++] = grid.cells[i];
    }
    grid.points.resize(kept);
    grid.cells.resize(kept);
    return grid;
}

}  // namespace interflect
