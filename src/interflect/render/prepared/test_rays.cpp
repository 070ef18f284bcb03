#include "interflect/render/prepared/test_rays.h"

#include <algorithm>

#include "interflect/base/threads/parallel.h"
#include "interflect/render/rays/shadow_rays.h"

namespace interflect::detail {

namespace {

constexpr std::size_t min_rays = 256, max_rays = 1 << 16;
constexpr std::size_t tests_per_task = 1 << 10;

}  // namespace

std::size_t test_rays_for(std::span<const SurfacePoint> points) {
    return std::clamp(points.size(), min_rays, max_rays);
}

const SurfacePoint& random_point(std::span<const SurfacePoint> points, std::uint32_t word) {
    return points[static_cast<std::size_t>((std::uint64_t{word} * points.size()) >> 32)];
}

TestedSources send_test_rays(const TracedScene& scene, std::size_t sources, std::size_t count,
                             const std::function<TestRay(std::size_t)>& sample) {
    struct Sent {
        std::uint32_t source = none;
        bool arrives = false;
        float light = 0;
    };
    std::vector<Sent> sent(count);
    parallel_for_ranges(count, tests_per_task, [&](std::size_t begin, std::size_t end) {
        ShadowRays rays;
        RayCounts counts;
        std::vector<std::size_t> indices;  // index of each ray in `sent`
        for (std::size_t i = begin; i < end; ++i) {
            const TestRay test = sample(i);
            if (test.source == none) continue;
            sent[i].source = test.source;
            sent[i].light = test.light;
            rays.add(test.ray, test.patch, test.distance);
            indices.push_back(i);
        }
        const std::span<const Rgb> transmittance = rays.trace(scene.ray_caster, scene.panes, counts);
        for (std::size_t k = 0; k < indices.size(); ++k)
            sent[indices[k]].arrives = largest_channel(transmittance[k]) > 0;
    });
    TestedSources tested;
    tested.sent.resize(sources);
    tested.arrived.resize(sources);
    for (const Sent& s : sent) {
        if (s.source == none) continue;
        ++tested.sent[s.source];
        tested.light_sent += static_cast<double>(s.light);
        if (s.arrives) {
            ++tested.arrived[s.source];
            tested.light_arrived += static_cast<double>(s.light);
        }
    }
    return tested;
}

}  // namespace interflect::detail
