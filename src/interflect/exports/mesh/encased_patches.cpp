#include "interflect/exports/mesh/encased_patches.h"

#include <algorithm>
#include <array>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/search/bounds.h"
#include "interflect/scene/core/core.h"
#include "interflect/solver/sampling/ray_maker.h"

namespace interflect::detail {

namespace {

/// Number of rays that are traced from a patch.
constexpr std::size_t rays_of_patch = 64;
/// Number of rays that may leave a closed solid, because they start within the ray offset of an edge.
constexpr std::size_t stray_rays = 2;
/// Width that separates solids and gaps, which are narrower, from rooms, which are wider [m].
constexpr float room_width = 0.5f;

class Surroundings {
  public:
    Surroundings(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark)
        : scene_(scene), ray_caster_(ray_caster), is_dark_(is_dark), diameter_(core_bounds(scene).size().length()) {}

    /// Traces rays from a patch. Counts long rays, and rays that reach a lit patch or escape.
    bool is_encased(PatchIndex patch) const {
        PointBlock points;
        std::array<Ray, rays_of_patch> rays;
        std::array<Parameters, rays_of_patch> origins;
        std::array<Hit, rays_of_patch> hits;
        const float offset = ray_caster_.ray_offset(patch);
        shoot_rays(PatchGeometry(scene_, scene_.patches[patch]), Cell(), offset, PointSet::sobol, patch, 0, points,
                   rays, origins);
        ray_caster_.trace(rays, hits);
        std::size_t far = 0, lit = 0;
        for (std::size_t i = 0; i < rays_of_patch; ++i) {
            const float distance = hits[i].patch == none ? diameter_ : hits[i].distance;
            const float obstacle = obstacle_distance(rays[i], hits[i], distance);
            const bool is_open = obstacle <= 2 * offset;
            lit += is_open && may_be_lit(hits[i]) ? 1 : 0;
            const float free_distance = is_open ? distance : obstacle;
            far += free_distance > room_width ? 1 : 0;
        }
        return lit <= stray_rays && 2 * far < rays_of_patch;
    }

  private:
    bool may_be_lit(const Hit& hit) const {
        return hit.patch == none || !is_dark_[hit.patch] ||
               scene_.materials[scene_.patches[hit.patch].material].transmittance != Rgb(0);
    }
    /// Traces the reversed ray, which stops at one-sided faces that the ray passed from behind. Returns the distance of
    /// this obstacle from the patch [m]; about 0 without an obstacle.
    float obstacle_distance(const Ray& ray, const Hit& hit, float distance) const {
        const float start = hit.patch == none ? distance : distance - ray_caster_.ray_offset(hit.patch);
        const Ray back{ray.origin + start * ray.direction, -ray.direction};
        Hit end;
        ray_caster_.trace({&back, 1}, {&end, 1});
        return end.patch == none ? 0 : std::max(0.0f, start - end.distance);
    }

    const Scene& scene_;
    const RayCaster& ray_caster_;
    const std::vector<bool>& is_dark_;
    float diameter_;  // [m]
};

}  // namespace

std::vector<bool> encased_patches(const Scene& scene, const RayCaster& ray_caster, const std::vector<bool>& is_dark) {
    const Surroundings surroundings(scene, ray_caster, is_dark);
    std::vector<char> encased(scene.patches.size(), 0);  // not bool, because threads write to neighbouring entries
    constexpr std::size_t patches_per_task = 1 << 8;
    parallel_for_ranges(encased.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            if (is_dark[p] && surroundings.is_encased(PatchIndex(p))) encased[p] = 1;
    });
    return {encased.begin(), encased.end()};
}

}  // namespace interflect::detail
