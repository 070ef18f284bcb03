#include "interflect/render/paths/path_integrator.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <numbers>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/render/paths/sky_guide.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// In hybrid shading, one in four paths also samples a direction at its first point, because close to a light source
/// sampled directions have less variance than shadow rays.
constexpr std::uint32_t paths_per_direction = 4;
constexpr std::uint64_t offset_stream = 2;  // argument of mix() for the choice of these paths
/// Paths of a smaller throughput are subject to Russian roulette. Lower thresholds reduce variance but lengthen paths;
/// values from 0.25 to 1 are equally efficient.
constexpr float roulette_threshold = 0.5f;

/// Returns a point of the gauge, lifted off its patch and moved along the normal by Gauge::offset.
V3f start_on(const TracedScene& s, const Gauge& gauge, const V3f& normal, float u, float v) {
    if (gauge.patch == none) return gauge.position + normal * gauge.offset;
    return s.lifted(gauge.patch, gauge.point_on(s.geometry[gauge.patch], u, v)) + normal * gauge.offset;
}

}  // namespace

void PathIntegrator::trace(std::span<SampleBatch> batches) {
    vertex_ = 1;
    keys_.clear();
    light_.assign(2 * batches.size(), {});
    paths_.clear();
    first_points_.clear();
    counts_ = {};
    for (const SampleBatch& b : batches)
        for (const std::uint64_t half : {0, 1})
            keys_.push_back(mix(mix(plan_.options.seed, b.pixel), 2 * std::uint64_t{b.number} + half));

    // Find the first points: points visible to the camera, or points on the gauges
    if (plan_.start.camera) {
        start_at_camera(batches);
        arrive_at_surfaces();
    } else {
        start_at_gauges(batches);
    }
    while (!paths_.paths.empty()) {
        // Send shadow rays to light sources and to bright elements or virtual lights
        illuminate_vertices();
        // Choose directions; Russian roulette ends some paths
        leave_surfaces();
        ++vertex_;
        // Find the next surfaces; add the light that they emit; end paths at known light
        arrive_at_surfaces();
    }
    // Combine shadow rays and unoccluded light of first points in hybrid shading
    first_points_.add_direct(light_);
    store(batches);
}

void PathIntegrator::start_at_camera(std::span<const SampleBatch> batches) {
    const auto width = static_cast<std::uint32_t>(plan_.options.width);
    thread_local PointBlock points;
    Path path;
    for (std::uint32_t h = 0; h < keys_.size(); ++h) {
        const SampleBatch& batch = batches[h / 2];
        fill_points(PointSet::sobol, keys_[h], batch.first_index, batch.size, points);
        const std::uint32_t column = batch.pixel % width, row = batch.pixel / width;
        const auto left = static_cast<float>(column), top = static_cast<float>(row);
        path.half_batch = h;
        path.sampling.is_last = batch.ends_at_first_hit;
        // Path::sample counts across batches, in the order of store()
        for (std::uint32_t i = 0; i < batch.size; ++i, ++path.sample) {
            path.index_in_sequence = batch.first_index + i;
            // The first path of a half gives the level for all
            path.level_samples = i == 0 ? batch.size : 0;
            paths_.add(path, plan_.start.camera->ray(left + points.coordinate[0][i], top + points.coordinate[1][i]));
        }
    }
    first_hits_.assign(path.sample, {});
}

void PathIntegrator::start_at_gauges(std::span<const SampleBatch> batches) {
    thread_local PointBlock points;
    Path path;
    for (std::uint32_t h = 0; h < keys_.size(); ++h) {
        const SampleBatch& batch = batches[h / 2];
        const Gauge& gauge = plan_.start.gauges[batch.pixel];
        fill_points(PointSet::sobol, keys_[h], batch.first_index, batch.size, points);
        path.half_batch = h;
        path.patch = gauge.patch;
        path.lookup = start_on(plan_.scene, gauge, gauge.normal, 0.5f, 0.5f);
        for (std::uint32_t i = 0; i < batch.size; ++i, ++path.sample) {
            path.index_in_sequence = batch.first_index + i;
            path.normal = gauge.normal_at(points.coordinate[0][i]);
            path.position = start_on(plan_.scene, gauge, path.normal, points.coordinate[1][i], points.coordinate[2][i]);
            paths_.add(path, {path.position, path.normal});  // leave_surfaces() replaces the ray before it is traced
        }
    }
    first_hits_.assign(path.sample, {});
}

void PathIntegrator::arrive_at_surfaces() {
    const bool is_first = vertex_ == 1;
    // A picture of irradiance shows all first surfaces as white, also panes and mirrors.
    const bool splits =
        (!plan_.scene.panes.empty() || plan_.scene.has_mirrors) && !(is_first && plan_.shows_irradiance());
    find_surfaces(plan_.scene, splits, is_first && plan_.options.mirrors, paths_, counts_);
    std::size_t alive = 0;
    for (std::size_t i = 0; i < paths_.paths.size(); ++i) {
        Path path = paths_.paths[i];
        if (arrive(paths_.hits[i], paths_.rays[i], path)) paths_.paths[alive++] = path;
    }
    paths_.paths.resize(alive);
    paths_.rays.resize(alive);
}

bool PathIntegrator::arrive(const Hit& hit, const Ray& ray, Path& path) {
    const TracedScene& s = plan_.scene;
    // Irradiance is drawn as the light of a white first surface that does not emit.
    const bool is_white = vertex_ == 1 && plan_.shows_irradiance();
    if (hit.patch == none) {
        ++counts_.escaped_rays;
        if (!is_white) add_sky(path, ray.direction);
        return false;
    }
    const V3f x = ray.origin + hit.distance * ray.direction;
    const float distance = path.travelled + hit.distance;
    auto [exitance, reflectance] = s.colours(hit.patch, x);
    if (is_white) {
        exitance = Rgb(0);
        reflectance = Rgb(1);
    }
    FirstHit& first_hit = first_hits_[path.sample];
    // A path behind clear panes or in a mirror comes later in paths_ than the path that it was split from, so its hit
    // overwrites that one.
    if (vertex_ == 1 && path.sets_first_hit) {
        first_hit = {RgbD(reflectance), Imath::V3d(s.geometry[hit.patch].normal()), Imath::V3d(x), distance};
        if (plan_.known && path.level_samples > 0)
            first_hit.level = path.level_samples * static_cast<double>(plan_.known->element_level(hit.patch, x));
    }
    if (vertex_ == 2 && !plan_.start.camera) {
        first_hit.inverse_length = 1 / static_cast<double>(distance);
        first_hit.hits = 1;
    }

    if (channel_sum(exitance) > 0) add_emission(hit, ray.direction, distance, path, exitance);
    if (vertex_ == 1 && plan_.hybrid) {
        assert(plan_.known);  // only plans for gauges may lack it, whose paths start at vertex 1 without a hit
        add_prediction(path, exitance / pi,
                       reflectance * plan_.known->irradiance(plan_.known->place(hit.patch, x)) / pi);
    }
    if (path.sampling.is_last || end_at_known_light(hit, x, ray.direction, distance, path)) return false;
    if (plan_.virtual_lights && vertex_ > 1)
        path.throughput *= share_beyond_virtual_lights(hit, ray.direction, distance, path);
    path.throughput *= reflectance;
    path.patch = hit.patch;
    path.position = path.lookup = s.lifted(hit.patch, x);
    // Later vertices are not visible, so they need no shading normal.
    path.normal = vertex_ == 1 ? s.shading_normal(hit.patch, x) : s.geometry[hit.patch].normal();
    return largest_channel(path.throughput) > 0;
}

void PathIntegrator::illuminate_vertices() {
    for (Path& path : paths_.paths) {
        path.sampling = {};
        if (vertex_ == 1) path.sampling.rays = plan_.first_shadow_rays;
        if (vertex_ == 1 && plan_.hybrid) {
            light_first_point(path);
            if (path.sampling.is_last) continue;  // records contain the light of the other connections
        } else {
            sample_sources(path);
        }
        if (plan_.known) connect_to_known_light(path);
        if (plan_.virtual_lights) connect_to_virtual_lights(path);
    }
    add_light_of_shadow_rays();
}

void PathIntegrator::light_first_point(Path& path) {
    const LightSources& sources = plan_.sources();
    const UnoccludedLight& unoccluded = plan_.scene.unoccluded;
    // Look up recorded indirect light; the path continues if no record is in reach
    const FirstPoints::Lookup lookup = first_points_.add_indirect(path, light_[path.half_batch]);
    if (!lookup.is_found) return sample_sources(path);
    // Some paths also sample a direction. Directions find the sky and emitting patches; but if patches have unoccluded
    // light, shadow rays alone sample them, as FirstPoints requires
    const bool has_sky = sources.skies().can_sample() || channel_sum(sources.skies().uniform_radiance()) > 0;
    SourceSampling& sampling = path.sampling;
    sampling.is_last = true;
    sampling.guide = lookup.guide;
    sampling.directions_find_patches = !unoccluded.has(SourceKind::patches);
    sampling.directions = sampling.directions_find_patches || has_sky ? 1.0f / paths_per_direction : 0;
    // Compute unoccluded light; shadow rays estimate the occlusion
    const LightSample numbers =
        unoccluded.samples_sources()
            ? light_sample(keys_[path.half_batch], vertex_, LightStream::unoccluded, path.index_in_sequence)
            : LightSample{};
    const std::uint32_t point = first_points_.add(path, numbers);
    for (const SourceKind kind : source_kinds) {
        const std::uint32_t rays = shadow_rays_to(kind, sampling.rays);
        const std::uint32_t first_point = unoccluded.has(kind) ? point : none;  // none: the path gets the light
        for (std::uint32_t k = 0; k < rays; ++k)
            connect_to_source(path, kind, path.index_in_sequence * rays + k, rays, first_point);
    }
    for (std::uint32_t k = 0; k < sampling.rays; ++k) connect_to_sky(path, path.index_in_sequence * sampling.rays + k);
}

std::uint32_t PathIntegrator::shadow_rays_to(SourceKind kind, std::uint32_t most) const {
    if (vertex_ == 1 && kind == SourceKind::suns && !plan_.has_suns) return 0;  // later vertices always see suns
    return plan_.sources().useful_rays(kind, most);
}

void PathIntegrator::sample_sources(Path& path) {
    if (vertex_ == 1 && !plan_.has_direct) return;
    for (const SourceKind kind : source_kinds) {
        const std::uint32_t rays = shadow_rays_to(kind, path.sampling.rays);
        for (std::uint32_t k = 0; k < rays; ++k)
            connect_to_source(path, kind, path.index_in_sequence * rays + k, rays, none);
    }
    for (std::uint32_t k = 0; k < path.sampling.rays; ++k)
        connect_to_sky(path, path.index_in_sequence * path.sampling.rays + k);
}

void PathIntegrator::connect_to_source(const Path& path, SourceKind kind, std::uint32_t index, std::uint32_t rays,
                                       std::uint32_t first_point) {
    constexpr std::array streams{LightStream::patches, LightStream::lamps, LightStream::suns};  // by SourceKind
    const LightSample numbers =
        light_sample(keys_[path.half_batch], vertex_, streams[static_cast<std::size_t>(kind)], index);
    const SourceSample source = plan_.sources().sample(kind, path.position, path.normal, numbers);
    if (!(channel_sum(source.irradiance) > 0)) return;
    const Rgb irradiance = source.irradiance / static_cast<float>(rays);
    shadow_rays_.add({path.position, source.direction}, source.patch, source.distance);
    if (first_point != none) {
        first_points_.add_sampled(first_point, kind, irradiance);
        connections_.push_back({.half_batch = path.half_batch,
                                .bounces = 1,
                                .light = irradiance,
                                .first_point = first_point,
                                .kind = kind});
        return;
    }
    float weight = 1;
    if (source.density > 0 && path.sampling.directions_find_patches)
        weight = balance(static_cast<float>(rays) * source.density, direction_density(path, source.direction));
    connections_.push_back({path.half_batch, vertex_, path.throughput / pi * irradiance * weight});
}

void PathIntegrator::connect_to_sky(const Path& path, std::uint32_t index) {
    const Skies& skies = plan_.sources().skies();
    const std::uint32_t guide = path.sampling.guide;
    if (!skies.can_sample() && guide == none) return;
    // If both can sample the sky, even shadow rays follow the guide and odd ones the brightness of the sky.
    const bool alternates = guide != none && skies.can_sample();
    const bool is_guided = guide != none && (!alternates || index % 2 == 0);
    const LightSample numbers =
        light_sample(keys_[path.half_batch], vertex_, is_guided ? LightStream::guided_skies : LightStream::skies,
                     alternates ? index / 2 : index);
    const V3f direction = is_guided
                              ? plan_.hybrid->guide->sample(guide, path.normal, numbers.choice, numbers.u, numbers.v)
                              : skies.sample(numbers.choice, numbers.u, numbers.v).direction;
    const float cosine = path.normal.dot(direction), density = sky_density(path, direction);
    if (!(cosine > 0 && density > 0)) return;
    const float weight = balance(density, direction_density(path, direction));
    shadow_rays_.add({path.position, direction}, no_patch, std::numeric_limits<float>::infinity());
    connections_.push_back(
        {path.half_batch, vertex_, path.throughput * sampled_sky(path, direction) * (cosine / pi / density * weight)});
}

void PathIntegrator::add_light_of_shadow_rays() {
    const std::span<const Rgb> transmittance = shadow_rays_.trace(plan_.scene.ray_caster, plan_.scene.panes, counts_);
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        const Connection& c = connections_[i];
        if (!(largest_channel(transmittance[i]) > 0)) continue;
        const Rgb light = c.light * transmittance[i];
        if (c.first_point != none)
            first_points_.add_visible(c.first_point, c.kind, light);
        else
            add(c.half_batch, c.bounces, light);
    }
    connections_.clear();
}

void PathIntegrator::leave_surfaces() {
    std::size_t alive = 0;
    for (Path path : paths_.paths) {
        const std::uint64_t key = keys_[path.half_batch];
        if (path.sampling.is_last) {
            // One path in four samples a direction. A random offset chooses it, so all have the same probability.
            const std::uint64_t offset = mix(key, offset_stream);
            if (!(path.sampling.directions > 0) || (path.index_in_sequence + offset) % paths_per_direction != 0)
                continue;
            path.throughput /= path.sampling.directions;
        }
        const VertexSample sample = vertex_sample(key, vertex_, path.index_in_sequence);
        const float survival = std::min(1.0f, largest_channel(path.throughput) / roulette_threshold);
        if (sample.roulette >= survival) continue;
        path.throughput /= survival;
        path.travelled = 0;
        paths_.rays[alive] = {path.position, cosine_direction(path.normal, sample.direction_u, sample.direction_v)};
        paths_.paths[alive++] = path;
    }
    paths_.paths.resize(alive);
    paths_.rays.resize(alive);
}

void PathIntegrator::store(std::span<SampleBatch> batches) const {
    // Irradiance = pi L of a white surface.
    const double per_radiance = plan_.shows_irradiance() ? std::numbers::pi : 1;
    std::size_t sample = 0;
    for (std::size_t b = 0; b < batches.size(); ++b) {
        SampleBatch& batch = batches[b];
        for (std::size_t h = 0; h < 2; ++h) {
            batch.halves[h] = light_[2 * b + h] * per_radiance;
            batch.halves[h].square_of_first_hit *= per_radiance;  // a square has the factor twice
        }
        for (const std::size_t end = sample + 2 * std::size_t{batch.size}; sample < end; ++sample)
            batch.first += first_hits_[sample];
        batch.done = true;
    }
}

void PathIntegrator::add_prediction(const Path& path, const Rgb& emitted, const Rgb& predicted) {
    PathLight& light = light_[path.half_batch];
    light.predicted += RgbD(path.throughput * predicted);
    const double seen = mean_channel(RgbD(path.throughput * (emitted + predicted)));
    light.square_of_first_hit += seen * seen;
}

void PathIntegrator::add_sky(const Path& path, const V3f& direction) {
    const Skies& skies = plan_.sources().skies();
    if (vertex_ == 1) {
        const Rgb seen = skies.seen(direction);
        add_prediction(path, seen, Rgb(0));
        return add(path.half_batch, 0, path.throughput * seen);
    }
    Rgb radiance = sampled_sky(path, direction);
    if (channel_sum(radiance) > 0)
        radiance *= balance(direction_density(path, direction), sky_density(path, direction));
    if (path.sampling.guide == none) radiance += skies.uniform_radiance();
    add(path.half_batch, vertex_ - 1, path.throughput * radiance);
}

void PathIntegrator::add_emission(const Hit& hit, const V3f& direction, float distance, const Path& path,
                                  const Rgb& exitance) {
    if (vertex_ > 1 && !path.sampling.directions_find_patches) return;  // shadow rays alone sample this light
    const Rgb radiance = path.throughput * exitance / pi;
    if (vertex_ == 1) return add(path.half_batch, 0, radiance);
    const float density =
        plan_.sources().density(hit.patch, path.position, path.normal, direction, distance * distance);
    const float weight = balance(direction_density(path, direction), static_cast<float>(path.sampling.rays) * density);
    add(path.half_batch, vertex_ - 1, radiance * weight);
}

float PathIntegrator::direction_density(const Path& path, const V3f& direction) {
    return path.normal.dot(direction) / pi * path.sampling.directions;
}

Rgb PathIntegrator::sampled_sky(const Path& path, const V3f& direction) const {
    const Skies& skies = plan_.sources().skies();
    return path.sampling.guide == none ? skies.sampled_radiance(direction) : skies.radiance(direction);
}

float PathIntegrator::sky_density(const Path& path, const V3f& direction) const {
    const Skies& skies = plan_.sources().skies();
    const auto rays = static_cast<float>(path.sampling.rays);
    const float of_sky = skies.can_sample() ? skies.density(direction) : 0;
    if (path.sampling.guide == none) return rays * of_sky;
    const float of_guide = plan_.hybrid->guide->density(path.sampling.guide, path.normal, direction);
    return skies.can_sample() ? rays * (of_sky + of_guide) / 2 : rays * of_guide;
}

void PathIntegrator::add(std::uint32_t half_batch, std::uint32_t bounces, const Rgb& radiance) {
    if (bounces == 1 && !plan_.has_direct) return;
    PathLight& light = light_[half_batch];
    if (bounces == 0)
        light.emitted += RgbD(radiance);
    else
        (bounces == 1 ? light.direct : light.indirect) += RgbD(radiance);
}

}  // namespace interflect::detail
