#include "interflect/render/paths/surface_points.h"

#include <algorithm>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/render/rays/path_rays.h"

namespace interflect::detail {

namespace {

constexpr std::size_t pixels_per_task = 2048;

/// Returns one camera ray for each pixel from `begin` to `end`.
PathRays camera_rays(const PathPlan& plan, std::size_t begin, std::size_t end) {
    const auto width = static_cast<std::size_t>(plan.options.width);
    PathRays rays;
    PointBlock points;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
        fill_points(PointSet::sobol, mix(plan.options.seed, pixel), 0, 1, points);
        const std::size_t column = pixel % width, row = pixel / width;
        const auto left = static_cast<float>(column), top = static_cast<float>(row);
        rays.add(Path(), plan.start.camera->ray(left + points.coordinate[0][0], top + points.coordinate[1][0]));
    }
    return rays;
}

std::vector<SurfacePoint> points_seen_by(const PathPlan& plan, PathRays rays) {
    const TracedScene& s = plan.scene;
    const bool splits = (!s.panes.empty() || s.has_mirrors) && !plan.shows_irradiance();
    RayCounts counts;
    find_surfaces(s, splits, plan.options.mirrors, rays, counts);
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
        const Hit& hit = rays.hits[i];
        if (hit.patch == none) continue;
        if (!plan.shows_irradiance() && largest_channel(s.material(hit.patch).reflectance) <= 0) continue;
        const V3f x = rays.rays[i].origin + hit.distance * rays.rays[i].direction;
        const float distance = rays.paths[i].travelled + hit.distance;
        points.push_back({s.lifted(hit.patch, x), s.shading_normal(hit.patch, x), hit.patch,
                          distance * plan.start.pixel_angle + plan.start.pixel_size});
    }
    return points;
}

}  // namespace

std::vector<SurfacePoint> first_points(const PathPlan& plan, const StopRequest& stop) {
    std::vector<SurfacePoint> points;
    for (const Gauge& g : plan.start.gauges) {
        const V3f middle = g.patch == none ? g.position : g.point_on(plan.scene.geometry[g.patch], 0.5f, 0.5f);
        const V3f start = g.patch == none ? middle : plan.scene.lifted(g.patch, middle);
        points.push_back({start + g.normal * g.offset, g.normal, g.patch, g.spacing()});
    }
    if (!plan.start.camera) return points;
    const std::size_t pixels =
        static_cast<std::size_t>(plan.options.width) * static_cast<std::size_t>(plan.options.height);
    std::vector<std::vector<SurfacePoint>> found((pixels + pixels_per_task - 1) / pixels_per_task);
    parallel_for_ranges(pixels, pixels_per_task, [&](std::size_t begin, std::size_t end) {
        if (!stop.is_due()) found[begin / pixels_per_task] = points_seen_by(plan, camera_rays(plan, begin, end));
    });
    for (const std::vector<SurfacePoint>& some : found) points.insert(points.end(), some.begin(), some.end());
    return points;
}

}  // namespace interflect::detail
