#include "interflect/render/paths/path_wavefront.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/geometry/texture_mapping.h"
#include "interflect/luminaires/illumination.h"

namespace interflect::detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Lower values reduce variance but lengthen paths; 0.25 to 1 are equally efficient.
constexpr float roulette_threshold = 0.5f;

/// Squared error times time in maze, office-graz and office2 (16 samples, filtered; one ray: 1): two rays 0.75, 0.82,
/// 0.66; four rays 0.63, 0.76, 0.51.
constexpr std::uint32_t gathered_shadow_rays = 4;
/// For hybrid shading: error of filtered pixels in office-graz, 16 samples: one ray 8.8%, two 6.5%, four 5.5% in 1.1
/// and 1.4 times the time of one.
constexpr std::uint32_t hybrid_shadow_rays = 4;
/// Paths of a record for each ray to a bright place. Two take 0.89 to 0.97 of the time of one in five scenes, with
/// equal errors; four up to 1.05 times the error in blocks of 9 pixels.
constexpr std::uint32_t record_paths_per_place = 2;
/// At the first vertex.
constexpr std::uint32_t virtual_shadow_rays = 4;

/// Uniform in the gauge's parallelogram, moved to its patch.
V3f start_on(const PathScene& s, const Gauge& gauge, float u, float v) {
    if (gauge.patch == none) return gauge.position;
    const PatchGeometry& geometry = s.geometry[gauge.patch];
    const V3f x = gauge.position + (u - 0.5f) * gauge.side_u + (v - 0.5f) * gauge.side_v;
    return s.lifted(gauge.patch, geometry.point(geometry.inset(geometry.parameters_of(x), gauge.inset)));
}

}  // namespace

V3f PathWavefront::start_of(const Ray& ray, const Path& path) { return ray.origin - path.travelled * ray.direction; }

void PathWavefront::trace(std::span<BatchOfPaths> batches) {
    light_.resize(batches.size() * s_.batch_size);
    for (const BatchOfPaths& b : batches)
        sequences_.push_back({mix(mix(s_.options.seed, b.pixel), b.batch), b.first_point});
    if (s_.start->camera)
        start_at_camera(batches);
    else
        start_at_gauges(batches);
    for (; !paths_.empty(); ++vertex_) advance_paths();
    add_light_of_seen_places();
    // Irradiance = pi L of a white surface.
    const double per_radiance = s_.options.quantity == PictureQuantity::irradiance ? std::numbers::pi : 1;
    for (std::size_t i = 0; i < light_.size(); ++i) {
        BatchOfPaths& batch = batches[i / s_.batch_size];
        batch.emitted += RgbD(light_[i].emitted) * per_radiance;
        batch.direct += RgbD(light_[i].direct) * per_radiance;
        batch.indirect += RgbD(light_[i].indirect) * per_radiance;
        batch.first += light_[i].first;
        batch.done = true;
    }
}

void PathWavefront::start_at_camera(std::span<const BatchOfPaths> batches) {
    const std::size_t size = s_.batch_size;
    const auto width = static_cast<std::uint32_t>(s_.options.width);
    thread_local PointBlock points;
    for (std::size_t b = 0; b < batches.size(); ++b) {
        fill_points(PointSet::sobol, sequences_[b].key, sequences_[b].first, size, points);
        const std::uint32_t column = batches[b].pixel % width, row = batches[b].pixel / width;
        const auto left = static_cast<float>(column), top = static_cast<float>(row);
        for (std::size_t i = 0; i < size; ++i) {
            rays_.push_back(s_.start->camera->ray(left + points.coordinate[0][i], top + points.coordinate[1][i]));
            paths_.push_back({Rgb(1, 1, 1), static_cast<std::uint32_t>(paths_.size()), V3f(0, 0, 0)});
        }
    }
}

void PathWavefront::start_at_gauges(std::span<const BatchOfPaths> batches) {
    const std::size_t size = s_.batch_size;
    thread_local PointBlock points;
    for (std::size_t b = 0; b < batches.size(); ++b) {
        fill_points(PointSet::sobol, sequences_[b].key, sequences_[b].first, size, points);
        const Gauge& gauge = s_.start->gauges[batches[b].pixel];
        const V3f middle = start_on(s_, gauge, 0.5f, 0.5f);
        for (std::size_t i = 0; i < size; ++i) {
            const V3f normal = gauge.normal_at(points.coordinate[0][i]);
            Path path{Rgb(1, 1, 1), static_cast<std::uint32_t>(b * size + i), normal, gauge.patch};
            Ray ray{start_on(s_, gauge, points.coordinate[1][i], points.coordinate[2][i]) + normal * gauge.offset,
                    normal};
            if (!leave(ray, path, middle)) continue;
            rays_.push_back(ray);
            paths_.push_back(path);
        }
    }
    trace_shadow_rays();
    ++vertex_;
}

void PathWavefront::advance_paths() {
    hits_.resize(rays_.size());
    s_.ray_caster.trace(rays_, hits_);
    split_paths();
    counts_.rays += static_cast<std::int64_t>(rays_.size());
    shadow_rays_.clear();
    connections_.clear();
    std::size_t alive = 0;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        Path path = paths_[i];
        Ray ray = rays_[i];
        if (!interact(hits_[i], ray, path)) continue;
        rays_[alive] = ray;
        paths_[alive++] = path;
    }
    rays_.resize(alive);
    paths_.resize(alive);
    trace_shadow_rays();
}

void PathWavefront::split_paths() {
    if (!s_.splits || shows_irradiance()) return;
    constexpr int max_splits = Panes::max_consecutive_panes;
    std::size_t first = 0;
    for (int round = 0; round < max_splits && first < rays_.size(); ++round) {
        const std::size_t end = rays_.size();
        for (std::size_t i = first; i < end; ++i) {
            const Hit hit = hits_[i];
            if (hit.patch == none) continue;
            const Material& m = s_.material(hit.patch);
            const Ray ray = rays_[i];  // copies: add_path() reallocates
            Path path = paths_[i];
            path.travelled += hit.distance;
            if (const Rgb through = s_.panes.transmittance(ray, hit); largest_channel(through) > 0)
                add_path(s_.panes.behind(ray, hit), path, through, reflectance_of_hit(ray, hit));
            if (vertex_ > 1 || !s_.options.mirrors || largest_channel(m.specular_reflectance) <= 0) continue;
            const V3f n = s_.geometry[hit.patch].normal();
            const V3f mirrored = ray.direction - 2 * n.dot(ray.direction) * n;
            add_path({s_.lifted(hit.patch, ray.origin + hit.distance * ray.direction), mirrored}, path,
                     m.specular_reflectance, reflectance_of_hit(ray, hit));
        }
        hits_.resize(rays_.size());
        s_.ray_caster.trace(std::span(rays_).subspan(end), std::span(hits_).subspan(end));
        first = end;
    }
}

void PathWavefront::add_path(const Ray& ray, const Path& path, const Rgb& share, const Rgb& reflectance) {
    constexpr float min_throughput = 1e-3f;  // further reflections in facing mirrors are invisible
    Path added = path;
    added.throughput *= share;
    added.sets_first_hit = path.sets_first_hit && largest_channel(reflectance) <= 0;
    if (largest_channel(added.throughput) < min_throughput) return;
    rays_.push_back(ray);
    paths_.push_back(added);
}

Rgb PathWavefront::reflectance_of_hit(const Ray& ray, const Hit& hit) const {
    const Parameters p = s_.geometry[hit.patch].parameters_of(ray.origin + hit.distance * ray.direction);
    return reflectance_at(s_.scene, s_.scene.patches[hit.patch], p);
}

bool PathWavefront::shows_irradiance() const {
    return vertex_ == 1 && s_.options.quantity == PictureQuantity::irradiance;
}

bool PathWavefront::interact(const Hit& hit, Ray& ray, Path& path) {
    if (hit.patch == none) {
        ++counts_.escaped_rays;
        if (!shows_irradiance()) add_sky(ray, path);
        return false;
    }
    const V3f x = ray.origin + hit.distance * ray.direction;
    const PatchGeometry& geometry = s_.geometry[hit.patch];
    const Material& material = s_.material(hit.patch);
    Rgb exitance = material.exitance, reflectance = material.reflectance;
    if (material.is_textured()) {
        const Patch& patch = s_.scene.patches[hit.patch];
        const Parameters p = geometry.parameters_of(x);
        exitance = exitance_at(s_.scene, patch, p);
        reflectance = reflectance_at(s_.scene, patch, p);
    }
    if (shows_irradiance()) exitance = Rgb(0), reflectance = Rgb(1);
    // Later paths, behind panes or in mirrors, overwrite it.
    if (vertex_ == 1 && path.sets_first_hit)
        light_[path.index].first = {RgbD(reflectance), Imath::V3d(geometry.normal()), Imath::V3d(x),
                                    path.travelled + hit.distance,
                                    s_.known ? static_cast<double>(s_.known->level(hit.patch, x)) : 0};
    const float distance = path.travelled + hit.distance;
    if (vertex_ == 2 && !s_.start->camera) light_[path.index].first.inverse_length = 1 / static_cast<double>(distance);
    if (channel_sum(exitance) > 0) add_emission(hit, ray, path, exitance);

    if (path.place != none || end_at_known_light(hit, ray, path)) return false;
    if (s_.virtual_lights && vertex_ > 1) path.throughput *= share_beyond_bound(hit, ray, path);
    path.throughput *= reflectance;
    if (largest_channel(path.throughput) <= 0) return false;
    path.normal = vertex_ == 1 && s_.smooth_normals
                      ? s_.smooth_normals->at(geometry, hit.patch, geometry.parameters_of(x))
                      : geometry.normal();
    path.patch = hit.patch;
    ray.origin = s_.lifted(hit.patch, x);
    if (s_.finds_points) {
        points_.push_back(
            {ray.origin, path.normal, hit.patch, distance * s_.start->pixel_angle + s_.start->pixel_size});
        return false;
    }
    return leave(ray, path, ray.origin);
}

bool PathWavefront::leave(Ray& ray, Path& path, const V3f& middle) {
    path.travelled = 0;
    path.place = s_.is_hybrid() && vertex_ == 1 ? seen_place(middle, path) : none;
    const std::uint64_t key = sequence(path).key;
    const std::uint32_t point = point_index(path);
    const bool samples_emitters = s_.options.emitter_sampling != EmitterSampling::directions;
    const std::uint32_t count = shadow_rays_at(vertex_);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t index = point * count + k;
        const LightSample sample = light_sample(key, vertex_, index);
        if (samples_emitters) connect_to_patch(ray.origin, path, sample);
        // Reflected paths hit no luminaires but skies.
        if (!s_.scene.luminaires.empty()) connect_to_luminaire(ray.origin, path, sample);
        if (samples_emitters) connect_to_sky(ray.origin, path, index);
    }
    if (s_.known && path.place == none) connect_to_known_light(ray.origin, path);
    if (s_.virtual_lights) connect_to_virtual_lights(ray.origin, path);

    if (path.place != none) {
        // Starts anywhere: the number of points need not be a multiple.
        const std::uint64_t start = mix(key, 2);
        if (!s_.directions_find_light() || (point + start) % paths_per_direction != 0) return false;
        path.throughput *= static_cast<float>(paths_per_direction);
    }
    const VertexSample sample = vertex_sample(key, vertex_, point);
    const float survival = std::min(1.0f, largest_channel(path.throughput) / roulette_threshold);
    if (sample.roulette >= survival) return false;
    path.throughput /= survival;
    ray.direction = cosine_direction(path.normal, sample.direction_u, sample.direction_v);
    return true;
}

std::uint32_t PathWavefront::seen_place(const V3f& x, const Path& path) {
    constexpr float same_cosine = 0.999f;
    const auto batch = path.index / static_cast<std::uint32_t>(s_.batch_size);
    std::size_t i = seen_.size();
    while (i > 0 && seen_[i - 1].batch == batch &&
           (seen_[i - 1].patch != path.patch || seen_[i - 1].normal.dot(path.normal) < same_cosine))
        --i;
    if (i == 0 || seen_[i - 1].batch != batch) {
        i = seen_.size() + 1;
        SeenPlace& place = seen_.emplace_back();
        place.batch = batch, place.patch = path.patch, place.index = path.index, place.normal = path.normal;
        if (s_.is_direct_only) {
            place.indirect = Rgb(0);
        } else if (const auto found = s_.indirect_field->at(x, path.normal, path.patch)) {
            place.indirect = found->irradiance;
            const bool is_guided = s_.sky_guide && s_.options.emitter_sampling == EmitterSampling::combined;
            if (is_guided && s_.sky_guide->sees_sky(found->record)) place.guide = found->record;
        }
        if (s_.unoccluded.has_patches()) place.patches.exact = s_.unoccluded.by_patches(x, path.normal, path.patch);
        if (s_.unoccluded.has_luminaires()) place.luminaires.exact = s_.unoccluded.by_luminaires(x, path.normal);
    }
    SeenPlace& place = seen_[i - 1];
    if (!place.indirect) return none;
    place.throughput += path.throughput;
    return static_cast<std::uint32_t>(i - 1);
}

Rgb PathWavefront::ExactLight::result() const {
    Rgb light(0);
    for (int c = 0; c < 3; ++c) {
        const float all = sampled[0][c] + sampled[1][c];
        if (!(all > 0)) continue;
        float share = (visible[0][c] + visible[1][c]) / all;
        // The bias of a ratio of sums falls with their number of terms: extrapolates (Quenouille 1956).
        if (sampled[0][c] > 0 && sampled[1][c] > 0)
            share = 2 * share - (visible[0][c] / sampled[0][c] + visible[1][c] / sampled[1][c]) / 2;
        light[c] = exact[c] * share;
    }
    return light;
}

void PathWavefront::add_light_of_seen_places() {
    for (const SeenPlace& place : seen_) {
        if (!place.indirect) continue;
        const Rgb per_irradiance = place.throughput / pi;
        add(place.index, 1, per_irradiance * (place.patches.result() + place.luminaires.result()));
        add(place.index, 2, per_irradiance * *place.indirect);
    }
}

void PathWavefront::estimate_visible_share(Connection& connection, const Path& path, ExactLight SeenPlace::*kind) {
    connection.place = path.place;
    connection.kind = kind;
    ExactLight& light = seen_[path.place].*kind;
    connection.half = light.next_half;
    light.next_half = 1 - light.next_half;
    light.sampled[connection.half] += connection.radiance;
}

void PathWavefront::add_sky(const Ray& ray, const Path& path) {
    if (vertex_ == 1) return add(path.index, 0, path.throughput * s_.skies.seen(ray.direction));
    Rgb radiance = sky_of_shadow_rays(path, ray.direction);
    if (channel_sum(radiance) > 0)
        radiance *=
            direction_weight(direction_density(path, ray.direction), sky_density(path, vertex_ - 1, ray.direction));
    if (guide_of(path) == none) radiance += s_.skies.uniform_radiance();
    add(path.index, vertex_ - 1, path.throughput * radiance);
}

std::uint32_t PathWavefront::guide_of(const Path& path) const {
    return path.place == none ? none : seen_[path.place].guide;
}

Rgb PathWavefront::sky_of_shadow_rays(const Path& path, const V3f& direction) const {
    return guide_of(path) == none ? s_.skies.sampled_radiance(direction) : s_.skies.radiance(direction);
}

float PathWavefront::sky_density(const Path& path, std::uint32_t vertex, const V3f& direction) const {
    const auto count = static_cast<float>(shadow_rays_at(vertex));
    const float of_sky = s_.skies.can_sample() ? s_.skies.density(direction) : 0;
    const std::uint32_t guide = guide_of(path);
    if (guide == none) return count * of_sky;
    const float of_guide = s_.sky_guide->density(guide, path.normal, direction);
    return s_.skies.can_sample() ? count * (of_sky + of_guide) / 2 : count * of_guide;
}

void PathWavefront::add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance) {
    if (path.place != none && s_.unoccluded.has_patches()) return;  // known exactly
    const Rgb radiance = path.throughput * exitance / pi;
    if (vertex_ == 1) return add(path.index, 0, radiance);
    const float distance = path.travelled + hit.distance;
    const float probability = s_.lights.probability(hit.patch, start_of(ray, path), path.normal);
    const float light_density =
        density_per_solid_angle(s_.geometry[hit.patch], probability, ray.direction, distance * distance);
    const auto count = static_cast<float>(shadow_rays_at(vertex_ - 1));
    const float weight = direction_weight(direction_density(path, ray.direction), count * light_density);
    add(path.index, vertex_ - 1, radiance * weight);
}

float PathWavefront::direction_density(const Path& path, const V3f& direction) const {
    const float density = path.normal.dot(direction) / pi;
    return path.place == none ? density : density / static_cast<float>(paths_per_direction);
}

float PathWavefront::direction_weight(float direction_density, float light_density) const {
    switch (s_.options.emitter_sampling) {
        case EmitterSampling::directions:
            return 1;
        case EmitterSampling::lights:
            return 0;
        default:
            return balance(direction_density, light_density);
    }
}

bool PathWavefront::end_at_known_light(const Hit& hit, const Ray& ray, const Path& path) {
    if (!s_.known || vertex_ == 1) return false;
    const KnownLight::Place place = s_.known->place(hit.patch, ray.origin + hit.distance * ray.direction);
    const float distance = path.travelled + hit.distance, distance2 = distance * distance;
    if (!s_.known->is_far(place, distance2)) return false;
    const float light_density = density_towards(place, start_of(ray, path), path.normal, ray.direction, distance2);
    const float weight = balance(path.normal.dot(ray.direction) / pi, light_density);
    add(path.index, vertex_, path.throughput * s_.known->reflected_radiance(place) * weight);
    return true;
}

void PathWavefront::connect_to_known_light(const V3f& x, const Path& path) {
    const std::uint32_t point = point_index(path), paths = paths_per_place();
    if (point % paths != 0) return;
    const PlaceSample sample = place_sample(sequence(path).key, vertex_, point / paths);
    const KnownLight::Place place = s_.known->sample(x, path.normal, sample.patch, sample.u, sample.v);
    if (place.patch == none) return;
    const V3f to_light = s_.geometry[place.patch].point(place.parameters) - x;
    const float distance2 = to_light.length2();
    if (!(distance2 > 0) || !s_.known->is_far(place, distance2)) return;
    const V3f direction = to_light / std::sqrt(distance2);
    const float direction_density = path.normal.dot(direction) / pi;
    const float light_density = density_towards(place, x, path.normal, direction, distance2);
    if (!(direction_density > 0 && light_density > 0)) return;
    const float weight = balance(light_density, direction_density);
    shadow_rays_.push_back({x, direction});
    connections_.push_back(
        {place.patch, path.index,
         path.throughput * s_.known->reflected_radiance(place) * (direction_density / light_density * weight), 0,
         vertex_ + 1});
}

float PathWavefront::density_towards(const KnownLight::Place& place, const V3f& x, const V3f& n, const V3f& direction,
                                     float distance2) const {
    const float cosine = -s_.geometry[place.patch].normal().dot(direction);
    if (!(cosine > 0)) return 0;
    return s_.known->density(place, x, n) * distance2 / (cosine * static_cast<float>(paths_per_place()));
}

void PathWavefront::connect_to_virtual_lights(const V3f& x, const Path& path) {
    const std::uint32_t count = vertex_ == 1 ? virtual_shadow_rays : 1;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double uniform = place_sample(sequence(path).key, vertex_, point_index(path) * count + k).patch;
        const LightTree::Choice choice = s_.virtual_lights->choose(x, path.normal, uniform);
        if (choice.index == none) continue;
        const VirtualLights::Light& light = s_.virtual_lights->lights()[choice.index];
        const V3f to_light = light.position - x;
        const float distance2 = to_light.length2();
        if (!(distance2 > 0)) continue;
        const V3f direction = to_light / std::sqrt(distance2);
        const float cosine = path.normal.dot(direction), other = -s_.geometry[light.patch].normal().dot(direction);
        if (!(cosine > 0 && other > 0)) continue;
        const float bounded = std::min(cosine * other / distance2, s_.virtual_lights->bound(light.patch));
        const float per_flux = bounded / (pi * pi * choice.probability * static_cast<float>(count));
        shadow_rays_.push_back({x, direction});
        connections_.push_back({light.patch, path.index, path.throughput * light.flux * per_flux, 0, vertex_ + 1});
    }
}

float PathWavefront::share_beyond_bound(const Hit& hit, const Ray& ray, const Path& path) const {
    const float distance = path.travelled + hit.distance, other = -s_.geometry[hit.patch].normal().dot(ray.direction);
    const float geometric_term = path.normal.dot(ray.direction) * std::max(0.0f, other) / (distance * distance);
    const float bound = s_.virtual_lights->bound(hit.patch);
    return geometric_term > bound ? 1 - bound / geometric_term : 0;
}

void PathWavefront::add(std::uint32_t index, std::uint32_t bounces, const Rgb& radiance) {
    if (bounces == 1 && s_.is_indirect_only) return;
    PathLight& light = light_[index];
    (bounces == 0 ? light.emitted : bounces == 1 ? light.direct : light.indirect) += radiance;
}

std::uint32_t PathWavefront::paths_per_place() const { return s_.is_indirect_only ? record_paths_per_place : 1; }

std::uint32_t PathWavefront::shadow_rays_at(std::uint32_t vertex) const {
    if (vertex == 1 && s_.is_indirect_only) return 0;
    if (vertex > 1) return 1;
    return s_.is_hybrid() ? hybrid_shadow_rays : s_.known ? gathered_shadow_rays : 1;
}

void PathWavefront::connect_to_patch(const V3f& x, const Path& path, const LightSample& sample) {
    const LightTree::Choice choice = s_.lights.choose(x, path.normal, sample.light);
    if (choice.index == none) return;
    const PatchGeometry& patch = s_.geometry[choice.index];
    const Parameters on_patch = patch.uniform_parameters(sample.u, sample.v);
    const V3f to_light = patch.point(on_patch) - x;
    const float distance2 = to_light.length2();
    if (!(distance2 > 0)) return;
    const V3f direction = to_light / std::sqrt(distance2);
    const float cosine = path.normal.dot(direction);
    const float light_density = static_cast<float>(shadow_rays_at(vertex_)) *
                                density_per_solid_angle(patch, choice.probability, direction, distance2);
    if (!(cosine > 0 && light_density > 0)) return;
    // Integrand: (rho / pi) (M / pi) cosine.
    const Rgb radiance =
        exitance_at(s_.scene, s_.scene.patches[choice.index], on_patch) / pi * (cosine / pi / light_density);
    Connection connection{choice.index, path.index, radiance, 0, vertex_};
    if (path.place != none && s_.unoccluded.has_patches())
        estimate_visible_share(connection, path, &SeenPlace::patches);
    else if (s_.options.emitter_sampling == EmitterSampling::lights)
        connection.radiance *= path.throughput;
    else
        connection.radiance *= path.throughput * balance(light_density, direction_density(path, direction));
    shadow_rays_.push_back({x, direction});
    connections_.push_back(connection);
}

void PathWavefront::connect_to_luminaire(const V3f& x, const Path& path, const LightSample& sample) {
    const Illumination light = s_.luminaires.choose(x, path.normal, sample);
    if (!(channel_sum(light.irradiance) > 0)) return;
    const float share = 1 / (pi * static_cast<float>(shadow_rays_at(vertex_)));
    Connection connection{none, path.index, light.irradiance * share, light.distance, vertex_};
    if (path.place != none && s_.unoccluded.has_luminaires())
        estimate_visible_share(connection, path, &SeenPlace::luminaires);
    else
        connection.radiance *= path.throughput;
    shadow_rays_.push_back({x, light.towards});
    connections_.push_back(connection);
}

void PathWavefront::connect_to_sky(const V3f& x, const Path& path, std::uint32_t index) {
    const std::uint32_t guide = guide_of(path);
    if (!s_.skies.can_sample() && guide == none) return;
    const bool takes_turns = guide != none && s_.skies.can_sample();
    const bool is_guided = guide != none && (!takes_turns || index % 2 == 0);
    const std::uint64_t key = sequence(path).key;
    const SkySample numbers = sky_sample(is_guided ? mix(key, 1) : key, vertex_, takes_turns ? index / 2 : index);
    const V3f direction = is_guided ? s_.sky_guide->sample(guide, path.normal, numbers.sky, numbers.u, numbers.v)
                                    : s_.skies.sample(numbers.sky, numbers.u, numbers.v).direction;
    const float cosine = path.normal.dot(direction);
    const float density = sky_density(path, vertex_, direction);
    if (!(cosine > 0 && density > 0)) return;
    const float weight = s_.options.emitter_sampling == EmitterSampling::lights
                             ? 1
                             : balance(density, direction_density(path, direction));
    const Rgb radiance = sky_of_shadow_rays(path, direction) * (cosine / pi / density * weight);
    shadow_rays_.push_back({x, direction});
    constexpr float infinitely_far = std::numeric_limits<float>::infinity();
    connections_.push_back({none, path.index, path.throughput * radiance, infinitely_far, vertex_});
}

void PathWavefront::pass_panes() {
    if (s_.panes.empty()) return;
    std::vector<std::size_t> passing;
    std::vector<Ray> rest;
    std::vector<Hit> behind;
    for (int round = 0; round < Panes::max_consecutive_panes; ++round) {
        passing.clear(), rest.clear();
        for (std::size_t i = 0; i < connections_.size(); ++i) {
            Connection& c = connections_[i];
            if (is_unoccluded(c, hits_[i])) continue;
            const Rgb through = s_.panes.transmittance(shadow_rays_[i], hits_[i]);
            if (!(largest_channel(through) > 0)) continue;
            passing.push_back(i);
            rest.push_back(s_.panes.behind(shadow_rays_[i], hits_[i]));
            c.radiance *= through;
            c.distance -= hits_[i].distance;
        }
        if (passing.empty()) return;
        behind.resize(rest.size());
        s_.ray_caster.trace(rest, behind);
        counts_.rays += static_cast<std::int64_t>(rest.size());
        for (std::size_t k = 0; k < passing.size(); ++k)
            shadow_rays_[passing[k]] = rest[k], hits_[passing[k]] = behind[k];
    }
}

bool PathWavefront::is_unoccluded(const Connection& connection, const Hit& hit) {
    // Escaped rays match luminaires and skies: neither has a patch.
    return hit.patch == connection.patch || (connection.patch == none && hit.distance > connection.distance);
}

void PathWavefront::trace_shadow_rays() {
    hits_.resize(shadow_rays_.size());
    s_.ray_caster.trace(shadow_rays_, hits_);
    pass_panes();
    counts_.rays += static_cast<std::int64_t>(shadow_rays_.size());
    counts_.shadow_rays += static_cast<std::int64_t>(shadow_rays_.size());
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        const Connection& c = connections_[i];
        if (!is_unoccluded(c, hits_[i])) continue;
        if (c.place == none)
            add(c.index, c.bounces, c.radiance);
        else
            (seen_[c.place].*c.kind).visible[c.half] += c.radiance;
    }
}

}  // namespace interflect::detail
