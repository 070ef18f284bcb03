#include <algorithm>
#include <vector>

#include "interflect/prepare.h"
#include "interflect/raycast/camera.h"

namespace interflect {

using namespace detail;

namespace {

constexpr int check_rows = 36;
constexpr int max_check_columns = 1024;  // for very wide pictures

std::vector<Ray> camera_rays(const Scene& scene, const View& view, float aspect) {
    const int columns = std::clamp(static_cast<int>(static_cast<float>(check_rows) * aspect), 1, max_check_columns);
    const Camera camera(view, columns, check_rows, scene.origin);
    std::vector<Ray> rays;
    for (int y = 0; y < check_rows; ++y)
        for (int x = 0; x < columns; ++x)
            rays.push_back(camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    return rays;
}

std::vector<Hit> hits_of(const RayCaster& ray_caster, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    return hits;
}

/// Returns a distance beyond the whole scene [m].
float beyond_all(const Scene& scene, const V3f& eye) {
    float farthest = 1;
    for (const V3f& v : scene.vertices) farthest = std::max(farthest, (v - eye).length());
    return 2 * farthest;
}

}  // namespace

ViewCoverage view_coverage(const Scene& scene, const RayCaster& ray_caster, const View& view, float aspect) {
    ray_caster.require_made_for(scene);
    const std::vector<Ray> rays = camera_rays(scene, view, aspect);
    const std::vector<Hit> hits = hits_of(ray_caster, rays);
    const float beyond = beyond_all(scene, rays.front().origin);

    // Reversed rays hit the fronts of the one-sided faces whose backs the rays pass.
    constexpr float almost = 0.9999f;  // excludes the face that was hit
    std::vector<Ray> backwards;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float distance = hits[i].patch == none ? beyond : almost * hits[i].distance;
        backwards.push_back({rays[i].origin + distance * rays[i].direction, -rays[i].direction});
    }
    const std::vector<Hit> hits_backwards = hits_of(ray_caster, backwards);
    std::size_t backs = 0, nothing = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float distance = (backwards[i].origin - rays[i].origin).length();
        if (hits_backwards[i].patch != none && hits_backwards[i].distance < distance)
            ++backs;
        else if (hits[i].patch == none)
            ++nothing;
    }
    const auto count = static_cast<double>(rays.size());
    return {static_cast<double>(nothing) / count, static_cast<double>(backs) / count};
}

}  // namespace interflect
