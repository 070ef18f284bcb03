#include "interflect/render/preview/lit_surfaces.h"

#include <numbers>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/render/rays/shadow_rays.h"

namespace interflect::detail {

namespace {

V3f point_of(const Ray& ray, const Hit& hit) { return ray.origin + hit.distance * ray.direction; }

}  // namespace

LitSurfaces::LitSurfaces(const TracedScene& scene, const Solution& solution, const View& view,
                         const PictureOptions& options, const CoarseLight& light, const PictureOptions& coarse,
                         std::uint32_t camera_rays)
    : scene_(scene),
      solution_(solution),
      options_(options),
      light_(light),
      camera_(view, options.width, options.height, scene.scene.origin),
      scale_(static_cast<float>(coarse.height) / static_cast<float>(options.height)),
      coarse_axis_(static_cast<float>(coarse.width) / 2),
      camera_rays_(camera_rays),
      shows_irradiance_(options.quantity == PictureQuantity::irradiance),
      splits_((!scene.panes.empty() || scene.has_mirrors) && !shows_irradiance_) {}

RayCounts LitSurfaces::draw(std::size_t begin, std::span<Rgb> pixels) const {
    RayCounts counts;
    std::vector<V2f> raster;
    PathRays rays = camera_rays(begin, pixels.size(), raster);
    find_surfaces(scene_, splits_, options_.mirrors, rays, counts);
    Sums sums(pixels.size(), RgbD(0));
    std::vector<std::uint32_t> shown(raster.size(), none);  // path whose hit each camera ray shows, as in layers
    for (std::uint32_t i = 0; i < rays.rays.size(); ++i) {
        const Path& path = rays.paths[i];
        sums[path.sample / camera_rays_] += RgbD(path.throughput * emitted_light(rays.rays[i], rays.hits[i]));
        if (rays.hits[i].patch == none)
            ++counts.escaped_rays;
        else if (path.sets_first_hit)
            shown[path.sample] = i;
    }
    // Add coarse light. For panes and mirrors that also reflect diffusely, it includes all light from them
    std::vector<bool> is_lit(rays.rays.size(), false);
    for (std::size_t k = 0; k < shown.size(); ++k) {
        if (shown[k] == none) continue;
        const Hit& hit = rays.hits[shown[k]];
        const V3f x = point_of(rays.rays[shown[k]], hit);
        const std::optional<Rgb> light = light_at(hit, x, raster[k]);
        const float per_light = shows_irradiance_ ? 1 : std::numbers::pi_v<float>;
        const Rgb irradiance = light ? *light * per_light : irradiance_of_element(hit.patch, x);
        is_lit[shown[k]] = !light;
        sums[k / camera_rays_] += RgbD(per_irradiance(hit, x) * irradiance);
    }
    if (scene_.sources.useful_rays(SourceKind::suns, 1) > 0) add_light_of_suns(begin, rays, is_lit, sums, counts);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = Rgb(sums[i] / static_cast<double>(camera_rays_));
    return counts;
}

PathRays LitSurfaces::camera_rays(std::size_t begin, std::size_t count, std::vector<V2f>& raster) const {
    const auto width = static_cast<std::size_t>(options_.width);
    PathRays rays;
    PointBlock points;
    Path path;
    for (std::size_t pixel = begin; pixel < begin + count; ++pixel) {
        fill_points(PointSet::sobol, mix(options_.seed, pixel), 0, camera_rays_, points);
        const std::size_t column = pixel % width, row = pixel / width;
        const V2f corner(static_cast<float>(column), static_cast<float>(row));
        for (std::uint32_t k = 0; k < camera_rays_; ++k, ++path.sample) {
            raster.push_back(corner + V2f(points.coordinate[0][k], points.coordinate[1][k]));
            rays.add(path, camera_.ray(raster.back().x, raster.back().y));
        }
    }
    return rays;
}

Rgb LitSurfaces::emitted_light(const Ray& ray, const Hit& hit) const {
    if (shows_irradiance_) return Rgb(0);
    if (hit.patch == none) return scene_.sources.skies().radiance_with_suns(ray.direction);
    return scene_.colours(hit.patch, point_of(ray, hit)).exitance / std::numbers::pi_v<float>;
}

Rgb LitSurfaces::per_irradiance(const Hit& hit, const V3f& x) const {
    return shows_irradiance_ ? Rgb(1) : scene_.colours(hit.patch, x).reflectance / std::numbers::pi_v<float>;
}

std::optional<Rgb> LitSurfaces::light_at(const Hit& hit, const V3f& x, const V2f& raster) const {
    const float from_middle = raster.x - static_cast<float>(options_.width) / 2;
    return light_.at(coarse_axis_ + scale_ * from_middle, scale_ * raster.y, x, scene_.geometry[hit.patch].normal());
}

Rgb LitSurfaces::irradiance_of_element(PatchIndex patch, const V3f& x) const {
    return solution_.irradiance[solution_.forest->leaf_at(patch, scene_.geometry[patch].parameters_of(x))];
}

void LitSurfaces::add_light_of_suns(std::size_t begin, const PathRays& rays, const std::vector<bool>& is_lit,
                                    Sums& sums, RayCounts& counts) const {
    struct Connection {
        std::uint32_t pixel;
        Rgb light;
    };
    std::vector<Connection> connections;
    ShadowRays shadow_rays;
    const std::uint32_t rays_of_point = scene_.sources.useful_rays(SourceKind::suns, 1);
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
        const Hit& hit = rays.hits[i];
        if (hit.patch == none || is_lit[i]) continue;
        const Path& path = rays.paths[i];
        const V3f found = point_of(rays.rays[i], hit), x = scene_.lifted(hit.patch, found);
        const std::uint32_t pixel = path.sample / camera_rays_;
        const Rgb reflected = path.throughput * per_irradiance(hit, found);
        for (std::uint32_t k = 0; k < rays_of_point; ++k) {
            const std::uint32_t index = (path.sample % camera_rays_) * rays_of_point + k;
            const SourceSample sun =
                scene_.sources.sample(SourceKind::suns, x, scene_.shading_normal(hit.patch, found),
                                      light_sample(mix(options_.seed, begin + pixel), 1, LightStream::suns, index));
            if (!(channel_sum(sun.irradiance) > 0)) continue;
            shadow_rays.add({x, sun.direction}, sun.patch, sun.distance);
            connections.push_back({pixel, reflected * sun.irradiance / static_cast<float>(rays_of_point)});
        }
    }
    const std::span<const Rgb> transmittance = shadow_rays.trace(scene_.ray_caster, scene_.panes, counts);
    for (std::size_t i = 0; i < connections.size(); ++i)
        sums[connections[i].pixel] += RgbD(connections[i].light * transmittance[i]);
}

}  // namespace interflect::detail
