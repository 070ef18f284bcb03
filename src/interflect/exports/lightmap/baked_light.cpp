#include "interflect/exports/lightmap/baked_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/base/threads/parallel.h"
#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/render/sharing/light_order.h"

namespace interflect::detail {

namespace {

/// Minimum distance of ray starts from the border of a patch, relative to the spacing of points. Otherwise rays at the
/// foot of a wall would start in its plane.
constexpr float inset = 0.05f;

SampledLight no_light(int width, int height) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {Image(width, height), Image(width, height), std::vector<float>(count), std::vector<float>(count)};
}

/// Filters the noise of direct light in a grid.
void filter(const PointGrid& grid, std::span<const Gauge> gauges, std::span<const GaugeLight> light,
            std::span<Rgb> irradiance) {
    const int width = grid.width, height = static_cast<int>(grid.points.size()) / width;
    PictureLayers layers;
    layers.is_indirect_interpolated = true;
    for (Image* image : {&layers.emitted, &layers.albedo, &layers.normal, &layers.position})
        *image = Image(width, height);
    for (SampledLight* l : {&layers.reflected, &layers.halves[0], &layers.halves[1]}) *l = no_light(width, height);
    layers.depth.resize(grid.points.size());
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        const std::uint32_t point = grid.points[i];
        if (point == none) continue;
        layers.depth[i] = 1;
        layers.pixel_size = std::max(layers.pixel_size, gauges[point].spacing());
        layers.albedo.pixels[i] = Rgb(1);
        layers.normal.pixels[i] = gauges[point].normal;
        layers.position.pixels[i] = gauges[point].position;
        layers.reflected.indirect.pixels[i] = light[point].indirect;
        for (std::size_t h = 0; h < 2; ++h) {
            layers.halves[h].direct.pixels[i] = light[point].halves[h].irradiance;
            layers.halves[h].direct_variance[i] = light[point].halves[h].squared_error;
        }
    }
    const Image filtered = denoise(layers);
    for (std::size_t i = 0; i < grid.points.size(); ++i)
        if (grid.points[i] != none) irradiance[grid.points[i]] = filtered.pixels[i];
}

}  // namespace

BakedLight::BakedLight(const Scene& scene, const Solution& solution, const BakeOptions& options,
                       const DirectSampling& sampling)
    : scene_(scene),
      solution_(solution),
      options_(options),
      sampling_(sampling),
      vertices_(scene, *solution.forest),
      smooth_(*solution.forest, vertices_, solution.irradiance),
      known_{*solution.forest, solution.irradiance, true} {
    if (options.shading == Shading::smooth) return;
    ray_caster_.emplace(scene);
    if (options.shading == Shading::hybrid || sampling.is_tested) traced_.emplace(scene, *ray_caster_);
}

std::vector<Rgb> BakedLight::irradiance(std::span<const BakedPoint> points, std::span<const PointGrid> grids,
                                        float spacing, const Monitor& monitor) const {
    if (options_.shading == Shading::hybrid) {
        const std::vector<Gauge> places = gauges(points, spacing);
        const PictureOptions path = path_options();
        give_order(monitor.ranks, {.kind = LightOrder::Kind::gauges, .options = path}, {{}, 0, places});
        const std::vector<GaugeLight> light = hybrid_irradiance(*traced_, known_, places, path, monitor);
        std::vector<Rgb> values;
        values.reserve(light.size());
        for (const GaugeLight& l : light) values.push_back(l.irradiance());
        for (const PointGrid& grid : grids) filter(grid, places, light, values);
        return values;
    }
    if (options_.shading == Shading::gather) return gathered(points, spacing, monitor);
    std::vector<Rgb> values(points.size());
    constexpr std::size_t points_per_task = 1 << 12;
    parallel_for_ranges(points.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = interpolated(points[i]);
    });
    return values;
}

std::vector<SampledIrradiance> BakedLight::direct(std::span<const BakedPoint> points, float spacing, int max_samples,
                                                  const Monitor& monitor) const {
    PictureOptions options = path_options();
    options.samples = std::min(options.samples, max_samples);
    const std::vector<Gauge> places = gauges(points, spacing);
    give_order(monitor.ranks, {.kind = LightOrder::Kind::direct_gauges, .options = options}, {{}, 0, places});
    return direct_irradiance(*traced_, places, options, monitor);
}

PictureOptions BakedLight::path_options() const {
    PictureOptions path;
    path.samples = require_samples(options_.shading, sampling_.use, options_.samples);
    if (options_.shading == Shading::hybrid) path.until = sampling_.max_noise;
    path.seed = options_.seed;
    path.quantity = PictureQuantity::irradiance;
    return path;
}

std::vector<Gauge> BakedLight::gauges(std::span<const BakedPoint> points, float spacing) const {
    std::vector<Gauge> gauges;
    gauges.reserve(points.size());
    for (const BakedPoint& point : points) {
        const PatchGeometry& geometry = solution_.forest->geometry(point.patch);
        const auto side = [&](const Parameters& p) {
            return geometry.shape().edge_u * p.u + geometry.shape().edge_v * p.v;
        };
        Gauge gauge;
        gauge.position = geometry.point(geometry.inset(point.at, inset * spacing));
        gauge.normal = vertices_.normals().at(geometry, point.patch, point.at);
        gauge.patch = point.patch;
        gauge.side_u = side(point.sides[0]);
        gauge.side_v = side(point.sides[1]);
        gauge.inset = inset * spacing;
        gauges.push_back(gauge);
    }
    return gauges;
}

std::vector<Rgb> BakedLight::gathered(std::span<const BakedPoint> points, float spacing, const Monitor& monitor) const {
    const std::vector<Gauge> places = gauges(points, spacing);
    std::vector<MeasuringPoint> measuring;
    measuring.reserve(points.size());
    for (const BakedPoint& point : points) {
        const PatchGeometry& geometry = solution_.forest->geometry(point.patch);
        V3f x(0);  // middle of the part of the gauge that is on the patch
        for (const float u : {0.25f, 0.75f})
            for (const float v : {0.25f, 0.75f}) x += places[measuring.size()].point_on(geometry, u, v) / 4;
        measuring.push_back({scene_.origin + Imath::V3d(x), places[measuring.size()].normal});
    }
    const MeasuringOptions options{.samples = path_options().samples, .seed = options_.seed};
    const std::vector<MeasuredIrradiance> measured =
        measure_irradiance(scene_, &solution_, *ray_caster_, measuring, options, monitor);
    const auto lit =
        std::count_if(measured.begin(), measured.end(), [](const MeasuredIrradiance& m) { return m.is_measured(); });
    if (static_cast<std::size_t>(lit) < measured.size())
        throw Stopped(fmt::format("stopped when {} of {} texels or vertices had light", lit, measured.size()));
    std::vector<Rgb> values;
    values.reserve(measured.size());
    for (const MeasuredIrradiance& m : measured) values.push_back(m.sum());
    return values;
}

}  // namespace interflect::detail
