#include "interflect/render/prepared/seen_sources.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "interflect/base/random.h"
#include "interflect/render/prepared/test_rays.h"

namespace interflect::detail {

namespace {

/// Weights can at most double the number of shadow rays that arrive.
constexpr float most_arrive = 0.5f;

float sum_of(const std::vector<float>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0f); }

/// Test rays to sources of a kind, in proportion to their unoccluded light.
TestedSources test(const TracedScene& scene, const LightSources& sources, SourceKind kind,
                   std::span<const SurfacePoint> points, std::uint64_t key) {
    const std::size_t count = std::max(scene.scene.patches.size(), scene.scene.luminaires.size());
    return send_test_rays(scene, count, test_rays_for(points), [&](std::size_t i) {
        const auto words = random_words(mix(key, 1), i), places = random_words(mix(key, 2), i);
        const SurfacePoint& p = random_one(points, words[0]);
        const LightSample numbers{unit_float(words[1]), unit_float(places[0]), unit_float(places[1]),
                                  unit_float(words[2])};
        const SourceSample source = sources.sample(kind, p.position, p.normal, numbers);
        if (!(channel_sum(source.irradiance) > 0)) return TestRay{};
        return TestRay{source.index, {p.position, source.direction}, source.patch, source.distance};
    });
}

/// Returns whether the sources got weights.
bool weigh(LightSources& sources, const TracedScene& scene, SourceKind kind, std::span<const SurfacePoint> points,
           std::uint64_t key) {
    TestedSources all;
    // The second round tests the sources that hidden ones have outshone.
    for (const std::uint64_t round : {0, 1}) {
        const TestedSources tested = test(scene, sources, kind, points, mix(key, round));
        if (round == 0 && sum_of(tested.arrived) >= most_arrive * sum_of(tested.sent)) return false;
        all.sent.resize(tested.sent.size()), all.arrived.resize(tested.sent.size());
        std::vector<float> weights(tested.sent.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            all.sent[i] += tested.sent[i], all.arrived[i] += tested.arrived[i];
            weights[i] = (1 + all.arrived[i]) / (1 + all.sent[i]);
        }
        sources.weigh(kind, weights);
    }
    return true;
}

}  // namespace

std::optional<LightSources> seen_sources(const TracedScene& scene, std::span<const SurfacePoint> points,
                                         std::uint64_t seed) {
    if (points.empty()) return {};
    LightSources sources = scene.sources;
    const std::uint64_t key = mix(seed, 0x5ee12);
    const bool has_patches = weigh(sources, scene, SourceKind::patches, points, mix(key, 1));
    const bool has_lamps = weigh(sources, scene, SourceKind::lamps, points, mix(key, 2));
    if (!has_patches && !has_lamps) return {};
    return sources;
}

}  // namespace interflect::detail
