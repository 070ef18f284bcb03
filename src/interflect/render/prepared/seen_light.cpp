#include "interflect/render/prepared/seen_light.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/render/prepared/test_rays.h"

namespace interflect::detail {

namespace {

/// Minimum reflected radiosity of sampled elements, relative to the visible mean. Sampling dimmer elements adds noise,
/// because cosine-distributed directions sample them well (Karlik et al. 2019): in a furnace, the standard deviation of
/// an estimate of 128 paths then increases from 1.8% to 2.6%.
constexpr float bright_over_mean = 2;
constexpr std::size_t rays_per_task = 1 << 10;

std::uint64_t key_of(std::uint64_t seed) { return mix(seed, 0x5ee11); }

/// Calls visit(ray, hit, transmittance) for all hits of surfaces, including those behind panes.
void trace(const TracedScene& scene, std::span<const Ray> rays, const auto& visit) {
    std::vector<Hit> hits(rays.size());
    scene.ray_caster.trace(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].patch != none) visit(i, hits[i], Rgb(1));
    if (scene.panes.empty()) return;
    std::vector<Panes::HitBehind> behind;
    scene.panes.trace(rays, hits, behind);
    for (const Panes::HitBehind& b : behind)
        if (b.hit.patch != none) visit(b.ray, b.hit, b.transmittance);
}

/// Returns the mean reflected radiosity that cosine-distributed rays from the points hit, sum of channels.
float mean_radiosity(const KnownLight& light, const TracedScene& scene, std::span<const SurfacePoint> points,
                     std::uint64_t key) {
    const std::size_t count = test_rays_for(points);
    const auto sum = parallel_sum(count, rays_per_task, 0.0, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray> rays;
        for (std::size_t i = begin; i < end; ++i) {
            const auto words = random_words(key, i);
            const SurfacePoint& p = random_point(points, words[0]);
            rays.push_back({p.position, cosine_direction(p.normal, unit_float(words[1]), unit_float(words[2]))});
        }
        double found = 0;
        trace(scene, rays, [&](std::size_t i, const Hit& hit, const Rgb& transmittance) {
            const V3f x = rays[i].origin + hit.distance * rays[i].direction;
            const Rgb radiance = transmittance * light.reflected_radiance(light.place(hit.patch, x));
            found += static_cast<double>(channel_sum(radiance)) * std::numbers::pi;
        });
        return found;
    });
    return static_cast<float>(sum / static_cast<double>(count));
}

/// Returns the share of the rays to each patch that hit it. A patch that received fewer rays than its power suggests
/// faces away from the points, so the missing rays count as occluded.
std::vector<float> seen_shares(const KnownLight& light, const TracedScene& scene, std::span<const SurfacePoint> points,
                               std::uint64_t key) {
    const std::size_t count = test_rays_for(points);
    const TestedSources tested = send_test_rays(scene, scene.geometry.size(), count, [&](std::size_t i) {
        const auto words = random_words(mix(key, 1), i), more_words = random_words(mix(key, 2), i);
        const SurfacePoint& p = random_point(points, words[0]);
        const KnownLight::Place place = light
                                            .sample(p.position, p.normal, unit_float(words[1]),
                                                    unit_float(more_words[0]), unit_float(more_words[1]))
                                            .place;
        if (place.patch == none) return TestRay{};
        const V3f to = scene.geometry[place.patch].point(place.parameters) - p.position;
        if (!(p.normal.dot(to) > 0 && scene.geometry[place.patch].normal().dot(to) < 0)) return TestRay{};
        return TestRay{place.patch, {p.position, to.normalized()}, place.patch};
    });
    const std::span<const float> powers = light.sampling_powers();
    const double power = std::accumulate(powers.begin(), powers.end(), 0.0);
    const auto rays_per_power = static_cast<float>(power > 0 ? static_cast<double>(count) / power : 0);
    std::vector<float> share(scene.geometry.size());
    for (std::size_t i = 0; i < share.size(); ++i)
        share[i] = (1 + tested.arrived[i]) / (1 + std::max(tested.sent[i], rays_per_power * powers[i]));
    return share;
}

}  // namespace

void sample_seen_light(KnownLight& light, const TracedScene& scene, std::span<const SurfacePoint> points,
                       std::uint64_t seed) {
    if (points.empty()) return;
    const std::uint64_t key = key_of(seed);
    light.sample_brighter_than(bright_over_mean * mean_radiosity(light, scene, points, key));
    // The first round identifies hidden patches, so the second round sends more rays to the others.
    for (const std::uint64_t round : {0, 1}) light.weigh(seen_shares(light, scene, points, mix(key, round)));
}

}  // namespace interflect::detail
