#include "interflect/exports/lightmap/baked_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interflect/base/threads/parallel.h"
#include "interflect/denoise.h"
#include "interflect/measure.h"
#include "interflect/render.h"
#include "interflect/render/sharing/light_order.h"

namespace interflect::detail {

namespace {

/// Minimum distance of ray starts from the border of a patch, relative to the shorter side of the point's area.
/// Otherwise rays at the foot of a wall would start in its plane.
constexpr float inset = 0.05f;

SampledLight no_light(int width, int height) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {Image(width, height), Image(width, height), std::vector<float>(count), std::vector<float>(count)};
}

/// A grid and its position in a picture of several grids [texels].
struct PlacedGrid {
    const PointGrid* points;
    int left = 0, top = 0;

    int width() const { return points->width; }
    int height() const { return static_cast<int>(points->points.size()) / points->width; }
    /// Calls visit(point, x, y) with the pixel of each point.
    void visit_points(const auto& visit) const {
        for (std::size_t i = 0; i < points->points.size(); ++i)
            if (points->points[i] != none)
                visit(points->points[i], left + static_cast<int>(i) % width(), top + static_cast<int>(i) / width());
    }
};

/// Places grids side by side in rows of about equal height, with empty texels between them.
std::vector<PlacedGrid> side_by_side(std::span<const PointGrid> grids) {
    constexpr int margin = 4;
    std::vector<PlacedGrid> placed;
    double texels = 0;
    for (const PointGrid& grid : grids) {
        placed.push_back({&grid});
        texels += static_cast<double>(grid.width + margin) * (placed.back().height() + margin);
    }
    std::stable_sort(placed.begin(), placed.end(),
                     [](const PlacedGrid& a, const PlacedGrid& b) { return a.height() > b.height(); });
    const auto row_width = static_cast<int>(std::ceil(std::sqrt(texels)));
    int left = 0, top = 0, row_height = 0;
    for (PlacedGrid& grid : placed) {
        if (left > 0 && left + grid.width() > row_width) {
            top += row_height + margin;
            left = row_height = 0;
        }
        grid.left = left;
        grid.top = top;
        left += grid.width() + margin;
        row_height = std::max(row_height, grid.height());
    }
    return placed;
}

/// Returns grids as a picture for the denoiser, in which only direct light has noise.
PictureLayers layers_of(std::span<const PlacedGrid> grids, std::span<const Gauge> gauges,
                        std::span<const GaugeLight> light) {
    int width = 0, height = 0;
    for (const PlacedGrid& grid : grids) {
        width = std::max(width, grid.left + grid.width());
        height = std::max(height, grid.top + grid.height());
    }
    PictureLayers layers;
    layers.is_indirect_interpolated = true;
    for (Image* image : {&layers.emitted, &layers.albedo, &layers.normal, &layers.position})
        *image = Image(width, height);
    for (SampledLight* l : {&layers.reflected, &layers.halves[0], &layers.halves[1]}) *l = no_light(width, height);
    layers.depth.resize(layers.albedo.pixels.size());
    for (const PlacedGrid& grid : grids)
        grid.visit_points([&](std::uint32_t point, int, int) {
            layers.pixel_size = std::max(layers.pixel_size, gauges[point].spacing());
        });
    for (std::size_t g = 0; g < grids.size(); ++g)
        grids[g].visit_points([&](std::uint32_t point, int x, int y) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            layers.depth[i] = 1;
            layers.albedo.pixels[i] = Rgb(1);
            layers.normal.pixels[i] = gauges[point].normal;
            // Grids lie in different planes, so that they exchange no light.
            constexpr float apart = 1000;  // [texels]
            layers.position.pixels[i] =
                gauges[point].position + gauges[point].normal * (apart * layers.pixel_size * static_cast<float>(g));
            layers.reflected.direct.pixels[i] = light[point].direct.irradiance;
            layers.reflected.indirect.pixels[i] = light[point].indirect;
            for (std::size_t h = 0; h < 2; ++h) {
                layers.halves[h].direct.pixels[i] = light[point].halves[h].irradiance;
                layers.halves[h].direct_variance[i] = light[point].halves[h].squared_error;
                layers.halves[h].indirect.pixels[i] = light[point].indirect;
            }
        });
    return layers;
}

/// Removes noise of direct light in grids.
void filter(std::span<const PointGrid> grids, std::span<const Gauge> gauges, std::span<const GaugeLight> light,
            Denoiser denoiser, std::span<Rgb> irradiance) {
    const auto filter_picture = [&](std::span<const PlacedGrid> placed) {
        const Image filtered = denoise(layers_of(placed, gauges, light), denoiser).image;
        for (const PlacedGrid& grid : placed)
            grid.visit_points([&](std::uint32_t point, int x, int y) { irradiance[point] = filtered.at(x, y); });
    };
    const std::vector<PlacedGrid> placed = side_by_side(grids);
    // A learned filter gets one large picture, because starting it takes longer than filtering most grids.
    if (available_denoiser(denoiser) == Denoiser::oidn) return filter_picture(placed);
    for (const PlacedGrid& grid : placed) filter_picture(std::array{PlacedGrid{grid.points}});
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
      known_(known_irradiance(scene, solution)) {
    known_.is_interpolated = true;
    if (options.shading == Shading::smooth) return;
    ray_caster_.emplace(scene);
    if (options.shading == Shading::hybrid || sampling.calls_direct) traced_.emplace(scene, *ray_caster_);
}

std::vector<Rgb> BakedLight::irradiance(std::span<const BakedPoint> points, std::span<const PointGrid> grids,
                                        const Monitor& monitor) const {
    if (options_.shading == Shading::hybrid) {
        const std::vector<Gauge> places = gauges(points, /*are_filtered=*/!grids.empty());
        const PictureOptions path = path_options();
        give_order(monitor.ranks, {.kind = LightOrder::Kind::gauges, .options = path}, {{}, 0, places});
        const std::vector<GaugeLight> light = hybrid_irradiance(*traced_, known_, places, path, monitor);
        std::vector<Rgb> values;
        values.reserve(light.size());
        for (const GaugeLight& l : light) values.push_back(l.irradiance());
        if (options_.denoiser && !grids.empty()) filter(grids, places, light, *options_.denoiser, values);
        return values;
    }
    if (options_.shading == Shading::gather) return gathered(points, monitor);
    std::vector<Rgb> values(points.size());
    constexpr std::size_t points_per_task = 1 << 12;
    parallel_for_ranges(points.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = interpolated(points[i]);
    });
    return values;
}

std::vector<SampledIrradiance> BakedLight::direct(std::span<const BakedPoint> points, int max_samples,
                                                  const Monitor& monitor) const {
    PictureOptions options = path_options();
    options.samples = std::min(options.samples, max_samples);
    const std::vector<Gauge> places = gauges(points);
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

std::vector<Gauge> BakedLight::gauges(std::span<const BakedPoint> points, bool are_filtered) const {
    std::vector<Gauge> gauges;
    gauges.reserve(points.size());
    for (const BakedPoint& point : points) {
        const PatchGeometry& geometry = solution_.forest->geometry(point.patch);
        const auto side = [&](const Parameters& p) {
            return geometry.shape().edge_u * p.u + geometry.shape().edge_v * p.v;
        };
        Gauge gauge;
        gauge.position = geometry.point(point.at);
        gauge.normal = vertices_.normals().at(geometry, point.patch, point.at);
        gauge.patch = point.patch;
        gauge.side_u = side(point.sides[0]);
        gauge.side_v = side(point.sides[1]);
        gauge.is_filtered = are_filtered;
        gauge.inset = inset * std::min(gauge.side_u.length(), gauge.side_v.length());
        gauges.push_back(gauge);
    }
    return gauges;
}

std::vector<Rgb> BakedLight::gathered(std::span<const BakedPoint> points, const Monitor& monitor) const {
    const std::vector<Gauge> places = gauges(points);
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
    const auto measured_count =
        std::count_if(measured.begin(), measured.end(), [](const MeasuredIrradiance& m) { return m.is_measured(); });
    if (static_cast<std::size_t>(measured_count) < measured.size())
        throw Stopped(
            fmt::format("stopped when {} of {} texels or vertices had light", measured_count, measured.size()));
    std::vector<Rgb> values;
    values.reserve(measured.size());
    for (const MeasuredIrradiance& m : measured) values.push_back(m.sum());
    return values;
}

}  // namespace interflect::detail
