#include "interflect/render/prepared/seen_sources.h"

#include <algorithm>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/render/prepared/test_rays.h"

namespace interflect::detail {

namespace {

/// The sources of a kind get weights if less than this share of their unoccluded light arrives. Weights make sampling
/// follow the unoccluded light less closely: in office-graz, they increase the error of a pixel from 2.8% to 3.2%.
constexpr double least_arriving = 0.125;

/// Traces test rays to the sources of a kind, in proportion to their unoccluded light.
TestedSources test(const TracedScene& scene, const LightSources& sources, SourceKind kind,
                   std::span<const SurfacePoint> points, std::uint64_t key) {
    const std::size_t count = std::max(scene.scene.patches.size(), scene.scene.luminaires.size());
    return send_test_rays(scene, count, test_rays_for(points), [&](std::size_t i) {
        const auto words = random_words(mix(key, 1), i), more_words = random_words(mix(key, 2), i);
        const SurfacePoint& p = random_point(points, words[0]);
        const LightSample numbers{unit_float(words[1]), unit_float(more_words[0]), unit_float(more_words[1]),
                                  unit_float(words[2])};
        const SourceSample source = sources.sample(kind, p.position, p.normal, numbers);
        if (!(channel_sum(source.irradiance) > 0)) return TestRay{};
        return TestRay{source.index,
                       {p.position, source.direction},
                       source.patch,
                       source.distance,
                       channel_sum(source.irradiance)};
    });
}

void add(TestedSources& all, const TestedSources& more) {
    for (std::size_t i = 0; i < all.sent.size(); ++i) {
        all.sent[i] += more.sent[i];
        all.arrived[i] += more.arrived[i];
    }
}

/// Returns the visible share of each source; 1 for sources without test rays.
std::vector<float> weights(const TestedSources& tested) {
    std::vector<float> weights(tested.sent.size());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = (1 + tested.arrived[i]) / (1 + tested.sent[i]);
    return weights;
}

}  // namespace

std::optional<LightSources> seen_sources(const TracedScene& scene, std::span<const SurfacePoint> points,
                                         std::uint64_t seed) {
    std::optional<LightSources> seen;
    if (points.empty()) return seen;
    for (const SourceKind kind : {SourceKind::patches, SourceKind::lamps}) {
        const std::uint64_t key = mix(mix(seed, 0x5ee12), static_cast<std::uint64_t>(kind));
        TestedSources tested = test(scene, scene.sources, kind, points, mix(key, 0));
        if (tested.light_arrived >= least_arriving * tested.light_sent) continue;
        if (!seen) seen.emplace(scene.sources);
        seen->weigh(kind, weights(tested));
        // Test again: bright hidden sources received most of the first test rays
        add(tested, test(scene, *seen, kind, points, mix(key, 1)));
        seen->weigh(kind, weights(tested));
    }
    return seen;
}

}  // namespace interflect::detail
