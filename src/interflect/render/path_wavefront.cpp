#include "interflect/render/path_wavefront.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/geometry/texture_mapping.h"
#include "interflect/luminaires/illumination.h"

namespace interflect::inline detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Throughput below which Russian roulette ends paths. Lower: less variance, longer paths; from 0.25 to 1 it is all
/// one.
constexpr float roulette_threshold = 0.5f;

/// Where a ray leaves the patch that another has hit at x: on the patch's surface, up by the ray caster's offset.
V3f offset_origin(const PathScene& s, std::uint32_t patch, const V3f& x) {
    const PatchGeometry& geometry = s.geometry[patch];
    return geometry.point(geometry.parameters_of(x)) + geometry.normal() * s.ray_caster.ray_offset(patch);
}

}  // namespace

void PathWavefront::trace(std::span<BatchOfPaths> batches) {
    start_paths(batches);
    for (vertex_ = 1; !paths_.empty(); ++vertex_) advance_paths();
    for (std::size_t i = 0; i < light_.size(); ++i) {
        BatchOfPaths& batch = batches[i / s_.batch_size];
        batch.emitted += RgbD(light_[i].emitted);
        batch.direct += RgbD(light_[i].direct);
        batch.indirect += RgbD(light_[i].indirect);
        batch.first += light_[i].first;
        batch.done = true;
    }
}

void PathWavefront::start_paths(std::span<const BatchOfPaths> batches) {
    const std::size_t size = s_.batch_size;
    thread_local PointBlock points;
    light_.assign(batches.size() * size, {});
    for (const BatchOfPaths& b : batches) {
        const std::uint64_t key = mix(mix(s_.seed, b.pixel), b.batch);
        keys_.push_back(key);
        fill_points(PointSet::sobol, key, 0, size, points);
        const auto width = static_cast<std::uint32_t>(s_.width);
        const std::uint32_t column = b.pixel % width, row = b.pixel / width;
        const auto left = static_cast<float>(column), top = static_cast<float>(row);
        for (std::size_t i = 0; i < size; ++i) {
            rays_.push_back(s_.camera.ray(left + points.coordinate[0][i], top + points.coordinate[1][i]));
            paths_.push_back({Rgb(1, 1, 1), static_cast<std::uint32_t>(paths_.size()), V3f(0, 0, 0)});
        }
    }
}

void PathWavefront::advance_paths() {
    hits_.resize(rays_.size());
    s_.ray_caster.trace(rays_, hits_);
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

bool PathWavefront::interact(const Hit& hit, Ray& ray, Path& path) {
    if (hit.patch == none) {
        ++counts_.escaped_rays;
        add(path.index, vertex_ - 1, path.throughput * s_.sky);
        return false;
    }
    const Material& material = s_.material(hit.patch);
    Rgb exitance = material.exitance, reflectance = material.reflectance;
    if (material.is_textured()) {
        const Patch& patch = s_.scene.patches[hit.patch];
        const Parameters p = s_.geometry[hit.patch].parameters_of(ray.origin + hit.distance * ray.direction);
        exitance = exitance_at(s_.scene, patch, p);
        reflectance = reflectance_at(s_.scene, patch, p);
    }
    if (vertex_ == 1)
        light_[path.index].first = {RgbD(reflectance), Imath::V3d(s_.geometry[hit.patch].normal()),
                                    Imath::V3d(ray.origin + hit.distance * ray.direction), hit.distance};
    if (channel_sum(exitance) > 0) add_emission(hit, ray, path, exitance);

    if (end_at_known_light(hit, ray, path)) return false;
    path.throughput *= reflectance;
    if (largest_channel(path.throughput) <= 0) return false;
    const std::uint32_t size = static_cast<std::uint32_t>(s_.batch_size);
    const VertexSample sample = vertex_sample(keys_[path.index / size], vertex_, path.index % size);
    ray.origin = offset_origin(s_, hit.patch, ray.origin + hit.distance * ray.direction);
    path.normal = s_.geometry[hit.patch].normal();
    if (s_.sampling != EmitterSampling::directions) connect_to_light(ray.origin, path, sample);
    if (s_.known) connect_to_known_light(ray.origin, path);
    if (!s_.scene.luminaires.empty()) connect_to_luminaire(ray.origin, path, sample);

    const float survival = std::min(1.0f, largest_channel(path.throughput) / roulette_threshold);
    if (sample.roulette >= survival) return false;
    path.throughput /= survival;
    ray.direction = cosine_direction(path.normal, sample.direction_u, sample.direction_v);
    return true;
}

void PathWavefront::add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance) {
    const Rgb radiance = path.throughput * exitance / pi;
    if (vertex_ == 1) return add(path.index, 0, radiance);
    float weight = 1;
    if (s_.sampling == EmitterSampling::lights) weight = 0;
    if (s_.sampling == EmitterSampling::combined) {
        const float probability = s_.lights.probability(hit.patch, ray.origin, path.normal);
        const float of_light =
            light_density(s_.geometry[hit.patch], probability, ray.direction, hit.distance * hit.distance);
        weight = balance(path.normal.dot(ray.direction) / pi, of_light);
    }
    add(path.index, vertex_ - 1, radiance * weight);
}

bool PathWavefront::end_at_known_light(const Hit& hit, const Ray& ray, const Path& path) {
    if (!s_.known || vertex_ == 1) return false;
    const KnownLight::Place place = s_.known->place(hit.patch, ray.origin + hit.distance * ray.direction);
    const float distance2 = hit.distance * hit.distance;
    if (!s_.known->is_far(place, distance2)) return false;
    const float of_light = density_towards(place, ray.origin, path.normal, ray.direction, distance2);
    const float weight = balance(path.normal.dot(ray.direction) / pi, of_light);
    add(path.index, vertex_, path.throughput * s_.known->radiance(place) * weight);
    return true;
}

void PathWavefront::connect_to_known_light(const V3f& x, const Path& path) {
    const auto size = static_cast<std::uint32_t>(s_.batch_size);
    const PlaceSample sample = place_sample(keys_[path.index / size], vertex_, path.index % size);
    const KnownLight::Place place = s_.known->sample(x, path.normal, sample.patch, sample.u, sample.v);
    if (place.patch == none) return;
    const V3f to_light = s_.geometry[place.patch].point(place.parameters) - x;
    const float distance2 = to_light.length2();
    if (!(distance2 > 0) || !s_.known->is_far(place, distance2)) return;
    const V3f direction = to_light / std::sqrt(distance2);
    const float of_direction = path.normal.dot(direction) / pi;
    const float of_light = density_towards(place, x, path.normal, direction, distance2);
    if (!(of_direction > 0 && of_light > 0)) return;
    const float weight = balance(of_light, of_direction);
    shadow_rays_.push_back({x, direction});
    connections_.push_back({place.patch, path.index,
                            path.throughput * s_.known->radiance(place) * (of_direction / of_light * weight), 0,
                            vertex_ + 1});
}

float PathWavefront::density_towards(const KnownLight::Place& place, const V3f& x, const V3f& n, const V3f& direction,
                                     float distance2) const {
    const float cosine = -s_.geometry[place.patch].normal().dot(direction);
    return cosine > 0 ? s_.known->density(place, x, n) * distance2 / cosine : 0;
}

void PathWavefront::add(std::uint32_t index, std::uint32_t bounces, const Rgb& radiance) {
    PathLight& light = light_[index];
    (bounces == 0 ? light.emitted : bounces == 1 ? light.direct : light.indirect) += radiance;
}

void PathWavefront::connect_to_light(const V3f& x, const Path& path, const VertexSample& sample) {
    const LightTree::Choice choice = s_.lights.choose(x, path.normal, sample.light);
    if (choice.patch == none) return;
    const PatchGeometry& lamp = s_.geometry[choice.patch];
    const Parameters on_lamp = lamp.uniform_parameters(sample.light_u, sample.light_v);
    const V3f to_light = lamp.point(on_lamp) - x;
    const float distance2 = to_light.length2();
    if (!(distance2 > 0)) return;
    const V3f direction = to_light / std::sqrt(distance2);
    const float of_direction = path.normal.dot(direction) / pi;  // density; also cosine / pi
    const float of_light = light_density(lamp, choice.probability, direction, distance2);
    if (!(of_direction > 0 && of_light > 0)) return;
    const float weight = s_.sampling == EmitterSampling::lights ? 1 : balance(of_light, of_direction);
    // The integral over the hemisphere of (rho / pi) (M / pi) cosine.
    const Rgb radiance = exitance_at(s_.scene, s_.scene.patches[choice.patch], on_lamp) / pi;
    shadow_rays_.push_back({x, direction});
    connections_.push_back(
        {choice.patch, path.index, path.throughput * radiance * (of_direction / of_light * weight), 0, vertex_});
}

void PathWavefront::connect_to_luminaire(const V3f& x, const Path& path, const VertexSample& sample) {
    const auto irradiance_from = [&](const Luminaire& luminaire, V3f& towards, float& distance) {
        const Illumination light = illumination(luminaire, x, sample.light_u, sample.light_v);
        towards = light.towards, distance = light.distance;
        return light.irradiance * std::max(0.0f, path.normal.dot(light.towards));
    };
    V3f towards;
    float distance = 0;
    double all = 0, chosen = 0;
    for (const Luminaire& luminaire : s_.scene.luminaires)
        all += channel_sum(irradiance_from(luminaire, towards, distance));
    if (!(all > 0)) return;
    for (const Luminaire& luminaire : s_.scene.luminaires) {
        const Rgb irradiance = irradiance_from(luminaire, towards, distance);
        const double share = channel_sum(irradiance) / all;
        chosen += share;
        if (!(share > 0) || sample.light > chosen) continue;
        shadow_rays_.push_back({x, towards});
        connections_.push_back(
            {none, path.index, path.throughput * irradiance / (pi * static_cast<float>(share)), distance, vertex_});
        return;
    }
}

void PathWavefront::trace_shadow_rays() {
    hits_.resize(shadow_rays_.size());
    s_.ray_caster.trace(shadow_rays_, hits_);
    counts_.rays += static_cast<std::int64_t>(shadow_rays_.size());
    counts_.shadow_rays += static_cast<std::int64_t>(shadow_rays_.size());
    for (std::size_t i = 0; i < connections_.size(); ++i) {
        const Connection& c = connections_[i];
        const bool is_reached = hits_[i].patch == c.patch || (c.patch == none && hits_[i].distance > c.distance);
        if (is_reached) add(c.index, c.bounces, c.radiance);
    }
}

}  // namespace interflect::inline detail
