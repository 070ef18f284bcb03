#include "interflect/render/reflections/virtual_lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/render/lights/path_samples.h"

namespace interflect::detail {

namespace {

constexpr std::size_t walks_per_task = 1 << 10;

/// Systematic sampling: splits [0, total) into `count` consecutive intervals of length size(i), and calls visit(i, n)
/// with the number n of points of a grid of spacing 1, with the random offset `uniform`, in interval i. The expected
/// value of n is size(i).
void sample_systematically(std::size_t count, double uniform, const auto& size, const auto& visit) {
    double end = 0;
    std::int64_t before = static_cast<std::int64_t>(std::floor(uniform));
    for (std::size_t i = 0; i < count; ++i) {
        end += size(i);
        const auto after = static_cast<std::int64_t>(std::floor(end + uniform));
        visit(i, static_cast<std::size_t>(after - before));
        before = after;
    }
}

}  // namespace

VirtualLights::VirtualLights(const Scene& scene, const RayCaster& ray_caster, std::span<const PatchGeometry> geometry,
                             const Panes& panes, std::size_t walks, std::uint64_t seed)
    : scene_(scene),
      ray_caster_(ray_caster),
      geometry_(geometry),
      panes_(panes),
      walks_(walks),
      seed_(mix(seed, 0x11947)),
      emission_(scene) {
    const std::vector<float> of_patches = emitted_powers(scene, geometry);
    source_power_.assign(of_patches.begin(), of_patches.end());
    for (std::size_t part = 0; part < emission_.part_count(); ++part)
        source_power_.push_back(channel_sum(emission_.power(part)));
    total_power_ = std::accumulate(source_power_.begin(), source_power_.end(), 0.0);
    compute_bounds();
}

/// Bounds the geometric term by the density of the lights [1/m^2]. Computes the bounds from a pilot set of lights that
/// draws no picture, because bounds that depend on the lights in use would bias the picture.
void VirtualLights::compute_bounds() {
    renew(none);
    const double area = std::accumulate(geometry_.begin(), geometry_.end(), 0.0,
                                        [](double sum, const PatchGeometry& g) { return sum + double{g.area()}; });
    std::vector<double> count(geometry_.size(), 0.0);
    for (const Light& light : lights_) ++count[light.patch];
    // Add one light and the mean area per light to each patch, so that the density of a small patch is close to the
    // mean.
    const double mean_area = area / std::max<double>(1, static_cast<double>(lights_.size()));
    bounds_.resize(geometry_.size());
    for (std::size_t i = 0; i < bounds_.size(); ++i)
        bounds_[i] = static_cast<float>((count[i] + 1) / (double{geometry_[i].area()} + mean_area));
}

void VirtualLights::renew(std::uint32_t number) {
    const std::uint64_t key = mix(seed_, number);
    lights_.clear();
    std::vector<Walk> walks = start(mix(key, 0));
    for (std::uint32_t step = 1; !walks.empty(); ++step) {
        const std::uint64_t step_key = mix(key, step);
        walks = survivors(meet_surfaces(walks), random_double(step_key, 0));
        add_lights(walks, mix(step_key, 1));
    }
    std::vector<LightTree::Light> lights;
    lights.reserve(lights_.size());
    for (std::uint32_t i = 0; i < lights_.size(); ++i) {
        const Light& light = lights_[i];
        lights.push_back(
            {i, channel_sum(light.flux), {light.position, light.position}, {geometry_[light.patch].normal(), 1}});
    }
    tree_.emplace(std::move(lights), lights_.size());
}

std::vector<VirtualLights::Walk> VirtualLights::start(std::uint64_t key) const {
    std::vector<Walk> walks;
    if (!(total_power_ > 0)) return walks;
    const double walks_per_power = static_cast<double>(walks_) / total_power_;
    sample_systematically(
        source_power_.size(), random_double(key, 0), [&](std::size_t s) { return source_power_[s] * walks_per_power; },
        [&](std::size_t s, std::size_t count) {
            if (count == 0) return;
            walks.resize(walks.size() + count);
            const std::span<Walk> added = std::span(walks).last(count);
            const std::uint64_t source_key = mix(key, s + 1);
            if (s < geometry_.size())
                start_at_patch(PatchIndex(s), source_key, added);
            else
                start_at_luminaire(s - geometry_.size(), source_key, added);
        });
    return walks;
}

void VirtualLights::start_at_patch(PatchIndex patch, std::uint64_t key, std::span<Walk> walks) const {
    const PatchGeometry& geometry = geometry_[patch];
    const V3f n = geometry.normal();
    // Flux of a walk per exitance: the power of the patch over the expected number of its walks.
    const auto flux_per_exitance = static_cast<float>(double{geometry.area()} * total_power_ /
                                                      (source_power_[patch] * static_cast<double>(walks_)));
    PointBlock points;
    for (std::size_t first = 0; first < walks.size(); first += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, walks.size() - first);
        fill_points(PointSet::sobol, key, first, count, points);
        const auto& [a, b, c, d] = points.coordinate;
        for (std::size_t i = 0; i < count; ++i) {
            const Parameters p = geometry.uniform_parameters(a[i], b[i]);
            const V3f x = geometry.point(p) + n * ray_caster_.ray_offset(patch);
            walks[first + i] = {{x, cosine_direction(n, c[i], d[i])},
                                exitance_at(scene_, scene_.patches[patch], p) * flux_per_exitance};
        }
    }
    if (ray_caster_.uncovered_share(patch) == 1) return;
    // Coincident faces cover a part of the patch; walks from that part carry no flux.
    std::vector<Ray> down;
    for (const Walk& walk : walks) down.push_back({walk.ray.origin, -n});
    std::vector<Hit> hits(down.size());
    ray_caster_.trace(down, hits);
    for (std::size_t i = 0; i < walks.size(); ++i)
        if (hits[i].patch != patch) walks[i].flux = Rgb(0);
}

void VirtualLights::start_at_luminaire(std::size_t part, std::uint64_t key, std::span<Walk> walks) const {
    const double power = source_power_[geometry_.size() + part];
    const auto expected_walks = static_cast<float>(power * static_cast<double>(walks_) / total_power_);
    PointBlock points;
    std::vector<Ray> rays(walks.size());
    emission_.shoot(part, PointSet::sobol, key, 0, points, rays);
    for (std::size_t i = 0; i < walks.size(); ++i) walks[i] = {rays[i], Rgb(emission_.power(part)) / expected_walks};
}

std::vector<VirtualLights::Walk> VirtualLights::meet_surfaces(std::span<const Walk> walks) {
    rays_ += static_cast<std::int64_t>(walks.size());
    const std::size_t per_walk = panes_.empty() ? 1 : 2;
    std::vector<Walk> met(walks.size() * per_walk);
    parallel_for_ranges(walks.size(), walks_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray> rays;
        for (const Walk& walk : walks.subspan(begin, end - begin)) rays.push_back(walk.ray);
        std::vector<Hit> hits(rays.size());
        ray_caster_.trace(rays, hits);
        for (std::size_t i = begin; i < end; ++i) {
            const Hit& hit = hits[i - begin];
            if (hit.patch == none) continue;
            const Ray& ray = walks[i].ray;
            const Parameters p = geometry_[hit.patch].parameters_of(ray.origin + hit.distance * ray.direction);
            met[i * per_walk] = {{geometry_[hit.patch].point(p), V3f(0)},
                                 walks[i].flux * reflectance_at(scene_, scene_.patches[hit.patch], p),
                                 hit.patch};
            if (panes_.empty()) continue;
            met[i * per_walk + 1] = {panes_.behind(ray, hit), walks[i].flux * panes_.transmittance(ray, hit)};
        }
    });
    return met;
}

/// Russian roulette by systematic sampling: a walk survives with the probability flux / starting flux, at most 1. The
/// number of survivors differs from its expected value by less than 1, and all lights have about equal flux.
std::vector<VirtualLights::Walk> VirtualLights::survivors(std::vector<Walk> walks, double uniform) const {
    const double starting_flux = total_power_ / static_cast<double>(walks_);
    const auto survival = [&](std::size_t i) {
        return std::min(1.0, static_cast<double>(channel_sum(walks[i].flux)) / starting_flux);
    };
    std::vector<Walk> alive;
    sample_systematically(walks.size(), uniform, survival, [&](std::size_t i, std::size_t count) {
        if (count == 0) return;
        alive.push_back(walks[i]);
        alive.back().flux /= static_cast<float>(survival(i));
    });
    return alive;
}

void VirtualLights::add_lights(std::span<Walk> walks, std::uint64_t key) {
    for (std::uint32_t i = 0; i < walks.size(); ++i) {
        Walk& walk = walks[i];
        if (walk.patch == none) continue;
        lights_.push_back({walk.ray.origin, walk.patch, walk.flux});
        const V3f n = geometry_[walk.patch].normal();
        const auto point = shuffled_point(key, i);
        walk.ray = {walk.ray.origin + n * ray_caster_.ray_offset(walk.patch), cosine_direction(n, point[0], point[1])};
    }
}

LightTree::Choice VirtualLights::choose(const V3f& x, const V3f& n, double uniform) const {
    return tree_->choose(x, n, uniform);
}

}  // namespace interflect::detail
