#include "interflect/render/paths/traced_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "interflect/base/monitor_section.h"
#include "interflect/base/shared_ranges.h"
#include "interflect/geometry/smooth_surfaces.h"
#include "interflect/render/paths/part_statistics.h"
#include "interflect/render/paths/seen_light.h"

namespace interflect::detail {

namespace {

/// Larger batches stratify little better; more batches improve the error estimate.
constexpr int largest_batch = 64;

std::vector<PatchGeometry> geometry_of(const Scene& scene) {
    std::vector<PatchGeometry> geometry;
    geometry.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    return geometry;
}

bool has_mirrors(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return largest_channel(m.specular_reflectance) > 0; });
}

}  // namespace

TracedScene::TracedScene(const Scene& scene, const RayCaster& ray_caster, const KnownIrradiance* known)
    : scene_(scene),
      ray_caster_(ray_caster),
      geometry_(geometry_of(scene)),
      lights_(patch_lights(scene, geometry_, emitted_powers(scene, geometry_)), scene.patches.size()),
      luminaires_(scene),
      skies_(scene),
      panes_(scene, ray_caster),
      unoccluded_(scene, geometry_),
      has_mirrors_(has_mirrors(scene)) {
    if (!scene.normals.empty()) smooth_normals_.emplace(scene, find_smooth_surfaces(scene));
    if (known) known_.emplace(*known);
}

PathScene TracedScene::paths(const PathStart& start, const PathOptions& options, std::size_t batch_size) const {
    PathScene paths{scene_,
                    ray_caster_,
                    &start,
                    geometry_,
                    lights_,
                    luminaires_,
                    skies_,
                    options,
                    batch_size,
                    panes_,
                    !panes_.empty() || has_mirrors_,
                    unoccluded_};
    if (smooth_normals_) paths.smooth_normals = &*smooth_normals_;
    return paths;
}

KnownLight TracedScene::known_light(const PathScene& paths, std::span<const SurfacePoint> points) const {
    KnownLight light(scene_, geometry_, known_->forest, known_->irradiance);
    sample_seen_light(light, paths, points);
    return light;
}

VirtualLights TracedScene::virtual_lights(const PathOptions& options) const {
    return {scene_, ray_caster_, geometry_, panes_, static_cast<std::size_t>(options.light_walks), options.seed};
}

std::size_t TracedScene::batch_size(int samples, int batches) {
    return std::bit_floor(static_cast<unsigned>(std::clamp(samples / batches, 1, largest_batch)));
}

std::vector<SurfacePoint> first_points(const PathScene& scene, const StopRequest& stop) {
    std::vector<SurfacePoint> points;
    for (const Gauge& g : scene.start->gauges) {
        const V3f start = g.patch == none ? g.position : scene.lifted(g.patch, g.position);
        points.push_back({start + g.normal * g.offset, g.normal, g.patch, g.spacing()});
    }
    if (!scene.start->camera) return points;
    PathScene finding = scene;
    finding.batch_size = 1;
    finding.finds_points = true;
    const std::size_t pixels =
        static_cast<std::size_t>(scene.options.width) * static_cast<std::size_t>(scene.options.height);
    std::vector<std::vector<SurfacePoint>> found((pixels + paths_per_tile - 1) / paths_per_tile);
    parallel_for_ranges(pixels, paths_per_tile, [&](std::size_t begin, std::size_t end) {
        if (stop.is_due()) return;
        std::vector<BatchOfPaths> batches;
        for (std::size_t i = begin; i < end; ++i) batches.push_back({.pixel = static_cast<std::uint32_t>(i)});
        PathWavefront wavefront(finding);
        wavefront.trace(batches);
        found[begin / paths_per_tile] = wavefront.points();
    });
    for (const std::vector<SurfacePoint>& some : found) points.insert(points.end(), some.begin(), some.end());
    return points;
}

namespace {

/// Traces the gauges `first`, ... Returns the number of rays.
std::int64_t trace_gauges(const PathScene& paths, std::size_t first, std::span<GaugeLight> irradiance) {
    const auto size = static_cast<std::uint32_t>(paths.batch_size);
    struct Light {
        PartStatistics direct, indirect;
        std::array<PartStatistics, 2> halves;  // of even and odd batches
    };
    std::vector<Light> light(irradiance.size());
    const auto sampled = [](const PartStatistics& s, float squared_error) {
        return SampledIrradiance{Rgb(s.mean), squared_error};
    };
    const auto result = [&](const Light& l) {
        const auto error = static_cast<float>(l.direct.squared_error());
        GaugeLight of_gauge{sampled(l.direct, error), {}, Rgb(l.indirect.mean)};
        for (std::size_t h = 0; h < 2; ++h)
            of_gauge.halves[h] = l.halves[h].batches > 0 ? sampled(l.halves[h], 2 * error) : of_gauge.direct;
        return of_gauge;
    };
    std::vector<BatchOfPaths> batches;
    std::int64_t rays = 0;
    const auto trace = [&] {
        PathWavefront wavefront(paths);
        wavefront.trace(batches);
        rays += wavefront.counts().rays;
        for (const BatchOfPaths& b : batches) {
            Light& l = light[b.pixel - first];
            l.halves[l.direct.batches % 2].add(b.direct / size);
            l.direct.add(b.direct / size);
            l.indirect.add(b.indirect / size);
        }
    };
    const auto add_batches = [&](std::size_t i, std::size_t from, std::size_t to) {
        for (std::size_t k = from; k < to; ++k)
            batches.push_back(
                {.pixel = static_cast<std::uint32_t>(first + i), .first_point = static_cast<std::uint32_t>(k) * size});
    };
    const double target = paths.options.until > 0 ? paths.options.until : hybrid_target;
    const std::size_t all_batches = static_cast<std::size_t>(paths.options.samples) / size;
    // Two batches agree about light that neither finds: only exact light may end early.
    const std::size_t first_batches = paths.directions_find_light() ? all_batches : 2;
    for (std::size_t i = 0; i < irradiance.size(); ++i) add_batches(i, 0, first_batches);
    trace();
    batches.clear();
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        if (std::sqrt(light[i].direct.squared_error()) >
            target * mean_channel(light[i].direct.mean + light[i].indirect.mean))
            add_batches(i, first_batches, all_batches);
    trace();
    for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i] = result(light[i]);
    return rays;
}

std::vector<GaugeLight> trace_all_gauges(const PathScene& paths, const Monitor& monitor) {
    const std::size_t gauges = paths.start->gauges.size();
    std::vector<GaugeLight> irradiance;
    constexpr std::size_t per_tile = 256;
    constexpr std::size_t tiles_per_report = 256;  // of each rank
    const CommonStop stop(monitor.stop, monitor.ranks);
    const std::size_t at_once =
        per_tile * tiles_per_report * (monitor.ranks ? static_cast<std::size_t>(monitor.ranks->count()) : 1);
    std::int64_t rays = 0;
    for (std::size_t first = 0; first < gauges; first += at_once) {
        const std::size_t count = std::min(at_once, gauges - first);
        std::vector<GaugeLight> light(count);
        std::vector<std::int64_t> rays_of_tile((count + per_tile - 1) / per_tile);
        parallel_for_own_ranges(monitor.ranks, count, per_tile, [&](std::size_t begin, std::size_t end) {
            if (stop.within_process().is_due()) return;
            rays_of_tile[begin / per_tile] =
                trace_gauges(paths, first + begin, std::span(light).subspan(begin, end - begin));
        });
        if (stop.is_due())
            throw Stopped(fmt::format("stopped when {} of {} texels or vertices had light", first, gauges));
        collect_ranges(monitor.ranks, std::span(light), per_tile, Destination::first_rank);
        collect_ranges(monitor.ranks, std::span(rays_of_tile), 1, Destination::first_rank);
        if (monitor.ranks && monitor.ranks->rank() != 0) continue;
        irradiance.insert(irradiance.end(), light.begin(), light.end());
        for (const std::int64_t of_tile : rays_of_tile) rays += of_tile;
        if (monitor.on_progress)
            monitor.on_progress({rays, static_cast<double>(first + count) / static_cast<double>(gauges)});
    }
    return irradiance;
}

PathStart start_at(std::span<const Gauge> gauges) {
    PathStart start;
    start.gauges = gauges;
    return start;
}

/// Batches have equal numbers of directions if each has a multiple of paths_per_direction.
std::size_t batch_size_of_gauges(const PathScene& paths) {
    constexpr int usual_batches = 8;
    const std::size_t size = TracedScene::batch_size(paths.options.samples, usual_batches);
    const bool has_two = paths.options.samples >= 2 * static_cast<int>(paths_per_direction);
    return paths.directions_find_light() && has_two ? std::max<std::size_t>(size, paths_per_direction) : size;
}

}  // namespace

std::vector<GaugeLight> hybrid_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                          const PathOptions& options, const Monitor& monitor) {
    const PathStart start = start_at(gauges);
    PathScene paths = scene.paths(start, options, 1);
    paths.batch_size = batch_size_of_gauges(paths);
    const CommonStop stop(monitor.stop, monitor.ranks);
    const std::vector<SurfacePoint> points = first_points(paths, stop.within_process());
    const KnownLight known = scene.known_light(paths, points);
    paths.known = &known;
    constexpr double share_of_records = 0.6;  // of the time; roughly
    const IndirectField field(paths, points, monitor_section(monitor, 0, share_of_records));
    paths.indirect_field = &field;
    const SkyGuide guide(paths, field, stop);
    paths.sky_guide = &guide;
    return trace_all_gauges(paths, monitor_section(monitor, share_of_records, 1, field.rays() + guide.rays()));
}

std::vector<SampledIrradiance> direct_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                                 const PathOptions& options, const Monitor& monitor) {
    const PathStart start = start_at(gauges);
    PathScene paths = scene.paths(start, options, 1);
    paths.batch_size = batch_size_of_gauges(paths);
    paths.is_direct_only = true;
    std::vector<SampledIrradiance> direct;
    for (const GaugeLight& light : trace_all_gauges(paths, monitor)) direct.push_back(light.direct);
    return direct;
}

}  // namespace interflect::detail
