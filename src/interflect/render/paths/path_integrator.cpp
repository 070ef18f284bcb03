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

// path_reflections.cpp defines the functions for known light and virtual lights.
namespace interflect::detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// In hybrid shading, one in four paths continues from a first point with a record, to find light sources. Close to a
/// source, sampled directions have less variance than shadow rays.
constexpr std::uint32_t paths_per_direction = 4;
/// Separates the random number that selects these paths from other uses of the key of a half batch.
constexpr std::uint64_t selection_stream = 2;
/// Weight of the element beside NearbyLight, whose weight is up to 12. Error a pixel of two samples with noise
/// reduction, and the largest error of a pixel where the elements are exact and direct light is noisy:
///
///     weight                                      0.1    1      2      4
///     office-graz                                 4.5    4.7    4.75   4.9%
///     furnace of textures, an eighth of the width 19     19     14     14%
constexpr float weight_of_elements = 2;
/// Paths of a smaller throughput are subject to Russian roulette. Lower thresholds reduce variance but lengthen paths;
/// values from 0.25 to 1 are equally efficient.
constexpr float roulette_threshold = 0.5f;

/// Returns a point of the gauge, lifted off its patch and moved along the normal by Gauge::offset.
/// @param u, v  Place on the patch, in [0, 1]; no effect for gauges in space.
V3f start_on(const TracedScene& scene, const Gauge& gauge, const V3f& normal, float u, float v) {
    if (gauge.patch == none) return gauge.position + normal * gauge.offset;
    return scene.lifted(gauge.patch, gauge.point_on(scene.geometry[gauge.patch], u, v)) + normal * gauge.offset;
}

LightStream stream_of(SourceKind kind) {
    constexpr std::array streams{LightStream::patches, LightStream::lamps, LightStream::suns};  // by SourceKind
    return streams[static_cast<std::size_t>(kind)];
}

}  // namespace

void PathIntegrator::trace(std::span<SampleBatch> batches, const NearbyLight* nearby) {
    vertex_ = 1;
    nearby_ = nearby;
    nearby_lookups_.clear();
    light_.assign(2 * batches.size(), {});
    paths_.clear();
    record_lookups_.clear();
    direct_light_.clear();
    counts_ = {};
    make_keys(batches);
    // Find the first points: points visible to the camera, or points on the gauges
    if (plan_.start.camera) {
        start_at_camera(batches);
        find_next_vertices();
    } else {
        start_at_gauges(batches);
    }
    while (!paths_.paths.empty()) {
        illuminate_vertices();
        choose_directions();
        ++vertex_;
        find_next_vertices();
    }
    // In hybrid shading, combine the shadow rays of first points with their unoccluded light
    direct_light_.add_to(light_);
    store(batches);
}

void PathIntegrator::make_keys(std::span<const SampleBatch> batches) {
    keys_.clear();
    pixels_.clear();
    for (const SampleBatch& batch : batches) {
        pixels_.push_back(batch.pixel);
        const std::uint64_t pixel_key = mix(plan_.options.seed, batch.pixel);
        for (const std::uint64_t half : {0, 1}) keys_.push_back(mix(pixel_key, 2 * std::uint64_t{batch.number} + half));
    }
}

void PathIntegrator::start_at_camera(std::span<const SampleBatch> batches) {
    const auto width = static_cast<std::uint32_t>(plan_.options.width);
    thread_local PointBlock points;
    Path path;
    for (std::uint32_t h = 0; h < keys_.size(); ++h) {
        const SampleBatch& batch = batches[h / 2];
        fill_points(PointSet::sobol, keys_[h], batch.first_index, batch.half_size, points);
        auto& x_in_pixel = points.coordinate[0];
        auto& y_in_pixel = points.coordinate[1];
        const bool is_fixed = batch.tracing == Tracing::fixed_places;
        if (is_fixed) x_in_pixel[0] = y_in_pixel[0] = h % 2 == 0 ? 0.0f : 0.5f;  // corner or centre
        const std::uint32_t row_index = batch.pixel / width;
        const auto column = static_cast<float>(batch.pixel % width), row = static_cast<float>(row_index);
        path.half_batch = h;
        path.sampling.ends_at_next_hit = batch.tracing != Tracing::paths;
        for (std::uint32_t i = 0; i < batch.half_size; ++i, ++path.sample) {
            path.index_in_sequence = batch.first_index + i;
            // Looking up the level of an element is slow, so the first path of a half batch does it for all of them.
            path.level_samples = i == 0 && !is_fixed ? batch.half_size : 0;
            paths_.add(path, plan_.start.camera->ray(column + x_in_pixel[i], row + y_in_pixel[i]));
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
        fill_points(PointSet::sobol, keys_[h], batch.first_index, batch.half_size, points);
        // The position on the gauge's arc determines the normal; u and v, where the path starts on the patch
        const auto& [position_on_arc, u, v, unused] = points.coordinate;
        path.half_batch = h;
        path.patch = gauge.patch;
        path.lookup_position = start_on(plan_.scene, gauge, gauge.normal, 0.5f, 0.5f);  // middle of the gauge
        for (std::uint32_t i = 0; i < batch.half_size; ++i, ++path.sample) {
            path.index_in_sequence = batch.first_index + i;
            path.normal = gauge.normal_at(position_on_arc[i]);
            path.position = start_on(plan_.scene, gauge, path.normal, u[i], v[i]);
            paths_.add(path, {path.position, path.normal});  // choose_directions() replaces this ray
        }
    }
    first_hits_.assign(path.sample, {});
}

void PathIntegrator::find_next_vertices() {
    const bool has_panes_or_mirrors = !plan_.scene.panes.empty() || plan_.scene.has_mirrors;
    // In pictures of irradiance, panes and mirrors count as white diffuse surfaces, too.
    const bool splits_paths = has_panes_or_mirrors && !next_surfaces_are_white();
    const bool mirrors_reflect = vertex_ == 1 && plan_.options.mirrors;
    find_surfaces(plan_.scene, splits_paths, mirrors_reflect, paths_, counts_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < paths_.paths.size(); ++i) {
        Path path = paths_.paths[i];
        if (move_to_hit(paths_.hits[i], paths_.rays[i], path)) paths_.paths[kept++] = path;
    }
    paths_.paths.resize(kept);
    paths_.rays.resize(kept);  // not the rays of the kept paths; choose_directions() replaces them
}

bool PathIntegrator::move_to_hit(const Hit& hit, const Ray& ray, Path& path) {
    if (hit.patch == none) {
        ++counts_.escaped_rays;
        if (!next_surfaces_are_white()) add_sky(path, ray.direction);
        return false;
    }
    const SurfaceHit surface = surface_hit(hit, ray, path);
    record_first_hit(surface, path);
    add_emission(surface, path);
    if (vertex_ == 1 && plan_.hybrid) add_prediction(path, surface.exitance / pi, predicted_radiance(surface, path));
    if (path.sampling.ends_at_next_hit) return false;
    if (end_at_known_light(surface, path)) return false;  // has added the known light
    // Virtual lights have already contributed a part of the light from this surface
    if (plan_.virtual_lights && vertex_ > 1) path.throughput *= share_beyond_virtual_lights(surface, path);
    path.throughput *= surface.reflectance;
    path.patch = surface.patch;
    path.position = path.lookup_position = plan_.scene.lifted(surface.patch, surface.x);
    // Later vertices are not visible, so they need no shading normal.
    path.normal = vertex_ == 1 ? plan_.scene.shading_normal(surface.patch, surface.x)
                               : plan_.scene.geometry[surface.patch].normal();
    return largest_channel(path.throughput) > 0;
}

PathIntegrator::SurfaceHit PathIntegrator::surface_hit(const Hit& hit, const Ray& ray, const Path& path) const {
    const V3f x = ray.origin + hit.distance * ray.direction;
    const SurfaceColours colours =
        next_surfaces_are_white() ? SurfaceColours{Rgb(0), Rgb(1)} : plan_.scene.colours(hit.patch, x);
    return {.patch = hit.patch,
            .x = x,
            .direction = ray.direction,
            .distance = path.travelled + hit.distance,
            .exitance = colours.exitance,
            .reflectance = colours.reflectance};
}

void PathIntegrator::record_first_hit(const SurfaceHit& hit, const Path& path) {
    FirstHit& first_hit = first_hits_[path.sample];
    // The hits of paths behind panes and in mirrors are recorded later. They replace the hit of a clear pane or pure
    // mirror. If the pane or mirror also reflects diffusely, find_surfaces() has cleared sets_first_hit of these paths.
    if (vertex_ == 1 && path.sets_first_hit) {
        first_hit = {.albedo = RgbD(hit.reflectance),
                     .normal = Imath::V3d(plan_.scene.geometry[hit.patch].normal()),
                     .position = Imath::V3d(hit.x),
                     .distance = hit.distance};
        if (plan_.known && path.level_samples > 0)
            first_hit.level = path.level_samples * static_cast<double>(plan_.known->element_level(hit.patch, hit.x));
    }
    const bool is_first_of_gauge = vertex_ == 2 && !plan_.start.camera;  // the gauge is vertex 1
    if (is_first_of_gauge) {  // behind panes, the farthest hit remains, without regard to sets_first_hit
        first_hit.inverse_length = 1 / static_cast<double>(hit.distance);
        first_hit.hits = 1;
    }
}

void PathIntegrator::add_sky(const Path& path, const V3f& direction) {
    const Skies& skies = plan_.sources().skies();
    if (vertex_ == 1) {
        const Rgb visible_radiance = skies.radiance_with_suns(direction);
        add_prediction(path, visible_radiance, Rgb(0));  // adds the square; only hybrid shading reads it
        add(path.half_batch, 0, path.throughput * visible_radiance);
        return;
    }
    Rgb radiance = sampled_sky(path, direction);
    if (channel_sum(radiance) > 0)
        radiance *= balance(direction_density(path, direction), sky_density(path, direction));
    // Without a guide, shadow rays do not sample uniform skies, so sampled directions contribute all their light
    if (path.sampling.guide == none) radiance += skies.uniform_radiance();
    add(path.half_batch, vertex_ - 1, path.throughput * radiance);
}

void PathIntegrator::add_emission(const SurfaceHit& hit, const Path& path) {
    if (!(channel_sum(hit.exitance) > 0)) return;
    const Rgb radiance = path.throughput * hit.exitance / pi;
    if (vertex_ == 1) {
        add(path.half_batch, 0, radiance);
        return;
    }
    if (!path.sampling.directions_find_patches) return;  // shadow rays contribute the whole emission
    const float source_density =
        plan_.sources().density(hit.patch, path.position, path.normal, hit.direction, hit.distance * hit.distance);
    const std::uint32_t shadow_rays = plan_.sources().useful_rays(SourceKind::patches, path.sampling.rays);
    const float weight =
        balance(direction_density(path, hit.direction), static_cast<float>(shadow_rays) * source_density);
    add(path.half_batch, vertex_ - 1, radiance * weight);
}

Rgb PathIntegrator::predicted_radiance(const SurfaceHit& hit, const Path& path) {
    assert(plan_.known);  // plans with a camera and hybrid shading have it
    const Rgb of_element = plan_.known->irradiance(plan_.known->place(hit.patch, hit.x)) / pi;
    if (!nearby_) return hit.reflectance * of_element;
    const auto& [light, weight] =
        nearby_lookups_.find(*nearby_, pixels_[path.half_batch / 2], hit.patch, plan_.scene.geometry[hit.patch]);
    return hit.reflectance * (weight * light + weight_of_elements * of_element) / (weight + weight_of_elements);
}

void PathIntegrator::add_prediction(const Path& path, const Rgb& emitted, const Rgb& predicted) {
    PathLight& light = light_[path.half_batch];
    light.predicted += RgbD(path.throughput * predicted);
    const double radiance = mean_channel(RgbD(path.throughput * (emitted + predicted)));
    light.square_of_first_hit += radiance * radiance;
}

void PathIntegrator::illuminate_vertices() {
    for (Path& path : paths_.paths) {
        path.sampling = {};
        if (vertex_ == 1) path.sampling.rays = plan_.first_shadow_rays;
        // With a record, light_first_point() adds the indirect light and connects the path to the sources
        if (vertex_ == 1 && plan_.hybrid && light_first_point(path)) continue;
        if (vertex_ > 1 || plan_.has_direct) connect_to_sources(path, false);
        if (plan_.known) connect_to_known_light(path);
        if (plan_.virtual_lights) connect_to_virtual_lights(path);
    }
    add_light_of_shadow_rays();
}

bool PathIntegrator::light_first_point(Path& path) {
    const RecordLookups::Lookup lookup =
        record_lookups_.add_indirect(path, pixels_[path.half_batch / 2], light_[path.half_batch]);
    if (!lookup.is_found) return false;
    path.sampling = sampling_with_record(lookup.guide);
    // Compute unoccluded light; shadow rays estimate the occlusion
    LightSample numbers{};
    if (plan_.scene.unoccluded_light.samples_sources())
        numbers = light_sample(keys_[path.half_batch], vertex_, LightStream::unoccluded, path.index_in_sequence);
    direct_light_.add_point(path, numbers);
    connect_to_sources(path, true);
    return true;
}

SourceSampling PathIntegrator::sampling_with_record(std::uint32_t guide) const {
    // DirectLight estimates the visible part of the unoccluded light of patches by shadow rays. Sampled directions
    // would add this light a second time.
    const bool directions_find_patches = !plan_.scene.unoccluded_light.has(SourceKind::patches);
    const Skies& skies = plan_.sources().skies();
    const bool directions_find_sky = skies.can_sample() || channel_sum(skies.uniform_radiance()) > 0;
    const bool needs_directions = directions_find_patches || directions_find_sky;
    return {.rays = plan_.first_shadow_rays,
            .guide = guide,
            .directions = needs_directions ? 1.0f / paths_per_direction : 0,
            .ends_at_next_hit = true,
            .directions_find_patches = directions_find_patches};
}

void PathIntegrator::connect_to_sources(const Path& path, bool is_first_point) {
    for (const SourceKind kind : source_kinds) {
        if (kind == SourceKind::suns && vertex_ == 1 && !plan_.has_direct_sunlight) continue;
        const std::uint32_t count = plan_.sources().useful_rays(kind, path.sampling.rays);
        const bool uses_direct_light = is_first_point && plan_.scene.unoccluded_light.has(kind);
        for (std::uint32_t number = 0; number < count; ++number)
            connect_to_source(path, {kind, number, count}, uses_direct_light);
    }
    const std::uint32_t sky_rays = path.sampling.rays;
    for (std::uint32_t number = 0; number < sky_rays; ++number)
        connect_to_sky(path, path.index_in_sequence * sky_rays + number);
}

void PathIntegrator::connect_to_source(const Path& path, const SourceRay& ray, bool uses_direct_light) {
    const LightSample numbers = light_sample(keys_[path.half_batch], vertex_, stream_of(ray.kind),
                                             path.index_in_sequence * ray.count + ray.number);
    const SourceSample source = plan_.sources().sample(ray.kind, path.position, path.normal, numbers);
    if (!(channel_sum(source.irradiance) > 0)) return;
    const auto count = static_cast<float>(ray.count);
    const Rgb irradiance = source.irradiance / count;
    shadow_rays_.add({path.position, source.direction}, source.patch, source.distance);
    Connection connection{.half_batch = path.half_batch, .bounces = vertex_};
    if (uses_direct_light) {
        connection.light = irradiance;
        connection.direct_ray = direct_light_.add_ray(ray.kind, source.index, irradiance);
    } else {
        float weight = 1;
        if (source.density > 0 && path.sampling.directions_find_patches)
            weight = balance(count * source.density, direction_density(path, source.direction));
        connection.light = path.throughput / pi * irradiance * weight;
    }
    connections_.push_back(connection);
}

void PathIntegrator::connect_to_sky(const Path& path, std::uint32_t index) {
    if (!plan_.sources().skies().can_sample() && path.sampling.guide == none) return;
    const V3f direction = sample_sky_direction(path, index);
    const float cosine = path.normal.dot(direction), density = sky_density(path, direction);
    if (!(cosine > 0 && density > 0)) return;
    const float weight = balance(density, direction_density(path, direction));
    const Rgb radiance = path.throughput * sampled_sky(path, direction) * (cosine / pi / density * weight);
    shadow_rays_.add({path.position, direction}, /*patch=*/no_patch, std::numeric_limits<float>::infinity());
    connections_.push_back({.half_batch = path.half_batch, .bounces = vertex_, .light = radiance});
}

V3f PathIntegrator::sample_sky_direction(const Path& path, std::uint32_t index) const {
    const Skies& skies = plan_.sources().skies();
    const bool has_guide = path.sampling.guide != none;
    // If both can sample the sky, rays of even index follow the guide. Rays of odd index follow the brightness
    // of the sky.
    const bool alternates = has_guide && skies.can_sample();
    const bool is_guided = alternates ? index % 2 == 0 : has_guide;
    const std::uint32_t index_in_stream = alternates ? index / 2 : index;
    const LightStream stream = is_guided ? LightStream::guided_skies : LightStream::skies;
    const LightSample numbers = light_sample(keys_[path.half_batch], vertex_, stream, index_in_stream);
    if (!is_guided) return skies.sample(numbers.choice, numbers.u, numbers.v).direction;
    return plan_.hybrid->guide->sample(path.sampling.guide, path.normal, numbers.choice, numbers.u, numbers.v);
}

void PathIntegrator::add_light_of_shadow_rays() {
    const std::span<const Rgb> transmittance = shadow_rays_.trace(plan_.scene.ray_caster, plan_.scene.panes, counts_);
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        const Connection& connection = connections_[i];
        if (!(largest_channel(transmittance[i]) > 0)) continue;
        const Rgb light = connection.light * transmittance[i];
        if (connection.direct_ray != none)
            direct_light_.set_visible(connection.direct_ray, light);
        else
            add(connection.half_batch, connection.bounces, light);
    }
    connections_.clear();
}

float PathIntegrator::direction_density(const Path& path, const V3f& direction) {
    return path.normal.dot(direction) / pi * path.sampling.directions;
}

float PathIntegrator::sky_density(const Path& path, const V3f& direction) const {
    const Skies& skies = plan_.sources().skies();
    const auto rays = static_cast<float>(path.sampling.rays);
    const float sky = skies.can_sample() ? skies.density(direction) : 0;
    if (path.sampling.guide == none) return rays * sky;
    const float guide = plan_.hybrid->guide->density(path.sampling.guide, path.normal, direction);
    if (!skies.can_sample()) return rays * guide;
    return rays * (sky + guide) / 2;  // half of the rays follow each of them
}

Rgb PathIntegrator::sampled_sky(const Path& path, const V3f& direction) const {
    const Skies& skies = plan_.sources().skies();
    return path.sampling.guide == none ? skies.sampled_radiance(direction) : skies.radiance(direction);
}

void PathIntegrator::choose_directions() {
    std::size_t kept = 0;
    for (Path path : paths_.paths) {  // a copy, because the paths that continue move to the front
        const std::uint64_t key = keys_[path.half_batch];
        if (path.sampling.ends_at_next_hit) {
            // The point has recorded light. Select one path in four; a random offset gives each path the same
            // probability
            const std::uint64_t offset = mix(key, selection_stream);
            const bool is_selected = (path.index_in_sequence + offset) % paths_per_direction == 0;
            const float probability = path.sampling.directions;  // 0 if no source needs sampled directions
            if (!(probability > 0) || !is_selected) continue;
            path.throughput /= probability;
        }
        const VertexSample sample = vertex_sample(key, vertex_, path.index_in_sequence);
        const float survival = std::min(1.0f, largest_channel(path.throughput) / roulette_threshold);
        if (sample.roulette >= survival) continue;
        path.throughput /= survival;
        path.travelled = 0;
        paths_.rays[kept] = {path.position, cosine_direction(path.normal, sample.direction_u, sample.direction_v)};
        paths_.paths[kept++] = path;
    }
    paths_.paths.resize(kept);
    paths_.rays.resize(kept);
}

void PathIntegrator::add(std::uint32_t half_batch, std::uint32_t bounces, const Rgb& radiance) {
    if (bounces == 1 && !plan_.has_direct) return;
    PathLight& light = light_[half_batch];
    if (bounces == 0)
        light.emitted += RgbD(radiance);
    else
        (bounces == 1 ? light.direct : light.indirect) += RgbD(radiance);
}

void PathIntegrator::store(std::span<SampleBatch> batches) const {
    // Irradiance = pi L of a white surface.
    const double factor = plan_.shows_irradiance() ? std::numbers::pi : 1;
    std::size_t sample = 0;
    for (std::size_t b = 0; b < batches.size(); ++b) {
        SampleBatch& batch = batches[b];
        for (std::size_t h = 0; h < 2; ++h) {
            batch.halves[h] = light_[2 * b + h] * factor;
            batch.halves[h].square_of_first_hit *= factor;  // a second time, because it is a square
        }
        // The samples of a batch are consecutive, as Path::sample counts them.
        for (FirstHit& first : batch.first)
            for (std::uint32_t i = 0; i < batch.half_size; ++i) first += first_hits_[sample++];
        batch.done = true;
    }
}

}  // namespace interflect::detail
