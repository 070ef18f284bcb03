#include "interflect/solver/transport.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

#include "interflect/base/fixed_point.h"
#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/solver/ray_source.h"

namespace interflect {

namespace {

/// Rays of one task: enough to hide the cost of a task, few enough to stay in the second-level cache.
constexpr std::size_t batch_rays = 4096;

/// Keys of the random numbers, so that no two purposes share one.
enum class Purpose : std::uint64_t { allocation = 1, sampling = 2 };

std::uint64_t stream_key(const SampleStreams& streams, Purpose purpose, std::uint64_t index) {
    return mix(mix(streams.seed, static_cast<std::uint64_t>(purpose)), index);
}

/// One task's rays and hits; one a thread, reused.
struct Batch {
    std::vector<Ray> rays = std::vector<Ray>(batch_rays);
    std::vector<Hit> hits = std::vector<Hit>(batch_rays);
    PointBlock points;
};

/// Which rays start where: those of patch s are first_ray[s] ... first_ray[s + 1] - 1.
struct RayPlan {
    const Surfaces& surfaces;
    const SampleStreams& streams;
    float lift;
    std::vector<std::int64_t> first_ray;

    RayPlan(const Surfaces& s, const RayCaster& ray_caster, std::span<const double> q, std::int64_t ray_count,
            const SampleStreams& sample_streams)
        : surfaces(s), streams(sample_streams), lift(ray_caster.lift()) {
        const std::uint64_t key = stream_key(streams, Purpose::allocation, 0);
        first_ray = allocate_rays(q, ray_count, random_double(key, streams.allocations));
    }

    std::int64_t count(std::size_t s) const { return first_ray[s + 1] - first_ray[s]; }

    /// Calls body(s, from, to) for every patch s that has rays in [begin, end): those from ... to - 1.
    template <class Body>
    void for_each_source(std::int64_t begin, std::int64_t end, const Body& body) const {
        const auto after = std::upper_bound(first_ray.begin(), first_ray.end(), begin);
        auto s = static_cast<std::size_t>(after - first_ray.begin() - 1);
        for (std::int64_t from = begin; from < end; ++s) {
            const std::int64_t to = std::min(first_ray[s + 1], end);
            if (to > from) body(s, from, to);
            from = to;
        }
    }

    /// Makes the rays begin ... begin + rays.size() - 1.
    void make_rays(std::int64_t begin, std::span<Ray> rays, PointBlock& points) const {
        const auto end = begin + static_cast<std::int64_t>(rays.size());
        for_each_source(begin, end, [&](std::size_t s, std::int64_t from, std::int64_t to) {
            const std::uint64_t sample = streams.used[s] + static_cast<std::uint64_t>(from - first_ray[s]);
            shoot_rays(surfaces.geometry(s), lift, streams.points, stream_key(streams, Purpose::sampling, s), sample,
                       points,
                       rays.subspan(static_cast<std::size_t>(from - begin), static_cast<std::size_t>(to - from)));
        });
    }
};

/// What one ray of each patch brings: P_s / (N q_s) [lm or W].
struct Quanta {
    std::vector<RgbD> colour;
    RgbD shot{0, 0, 0};
    std::int64_t non_finite = 0;
};

Quanta make_quanta(std::span<const Rgb> power, std::span<const double> q, const RayPlan& plan) {
    double q_sum = 0;
    for (const double w : q) q_sum += w;
    const double scale = q_sum / static_cast<double>(plan.first_ray.back());
    Quanta quanta;
    quanta.colour.resize(power.size(), RgbD(0, 0, 0));
    for (std::size_t s = 0; s < power.size(); ++s) {
        const std::int64_t count = plan.count(s);
        if (!is_finite(power[s])) ++quanta.non_finite;
        if (count == 0 || !is_finite(power[s])) continue;
        quanta.colour[s] = RgbD(power[s]) * (scale / q[s]);
        quanta.shot += quanta.colour[s] * static_cast<double>(count);
    }
    return quanta;
}

}  // namespace

std::vector<std::int64_t> allocate_rays(std::span<const double> q, std::int64_t ray_count, double offset) {
    double q_sum = 0;
    for (const double w : q) q_sum += w;
    assert(q_sum > 0 && std::isfinite(q_sum));
    std::vector<std::int64_t> first(q.size() + 1, 0);
    double cumulative = 0;  // summed in the order of q_sum, so that it ends at q_sum exactly, and the rays at N
    for (std::size_t s = 0; s < q.size(); ++s) {
        cumulative += q[s];
        const double rays = cumulative / q_sum * static_cast<double>(ray_count) + offset;
        first[s + 1] = std::min(ray_count, static_cast<std::int64_t>(rays));  // N + offset may round up to N + 1
    }
    return first;
}

std::vector<double> power_weights(std::span<const Rgb> power) {
    std::vector<double> q(power.size());
    for (std::size_t s = 0; s < q.size(); ++s) q[s] = is_finite(power[s]) ? channel_sum(RgbD(power[s])) : 0.0;
    return q;
}

Received receive_power(const Surfaces& surfaces, const RayCaster& ray_caster, std::span<const Rgb> power,
                       std::span<const double> q, std::int64_t ray_count, SampleStreams& streams) {
    assert(power.size() == surfaces.size() && q.size() == surfaces.size() && ray_count > 0);
    Received received;
    received.power.resize(surfaces.size(), Rgb(0, 0, 0));
    if (std::all_of(q.begin(), q.end(), [](double w) { return w == 0; })) return received;

    const RayPlan plan(surfaces, ray_caster, q, ray_count, streams);
    const Quanta quanta = make_quanta(power, q, plan);
    received.shot_power = quanta.shot;
    received.non_finite = quanta.non_finite;
    if (!(channel_sum(quanta.shot) > 0)) return received;

    const FixedPoint fixed_point(channel_sum(quanta.shot));
    ConcurrentSums sums(surfaces.size() + 1);  // the last one is for what escapes
    std::atomic<std::int64_t> escaped_rays{0};
    tbb::enumerable_thread_specific<Batch> batches;
    parallel_for_ranges(static_cast<std::size_t>(ray_count), batch_rays, [&](std::size_t begin, std::size_t end) {
        Batch& batch = batches.local();
        const std::span rays(batch.rays.data(), end - begin);
        const std::span hits(batch.hits.data(), end - begin);
        const auto first = static_cast<std::int64_t>(begin);
        plan.make_rays(first, rays, batch.points);
        ray_caster.trace(rays, hits);

        std::int64_t escaped = 0;
        plan.for_each_source(first, static_cast<std::int64_t>(end),
                             [&](std::size_t s, std::int64_t from, std::int64_t to) {
                                 const FixedPoint::Value quantum = fixed_point.from(quanta.colour[s]);
                                 for (std::int64_t r = from; r < to; ++r) {
                                     const std::uint32_t receiver = hits[static_cast<std::size_t>(r - first)].patch;
                                     escaped += receiver == none;
                                     sums.add(receiver == none ? surfaces.size() : receiver, quantum);
                                 }
                             });
        escaped_rays.fetch_add(escaped, std::memory_order_relaxed);
    });

    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        received.power[i] = Rgb(fixed_point.to_colour(sums[i]));
        streams.used[i] += static_cast<std::uint64_t>(plan.count(i));
    }
    ++streams.allocations;
    received.escaped_power = fixed_point.to_colour(sums[surfaces.size()]);
    received.escaped_rays = escaped_rays;
    return received;
}

std::vector<Ray> transport_rays(const Surfaces& surfaces, const RayCaster& ray_caster, std::span<const double> q,
                                std::int64_t ray_count, const SampleStreams& streams) {
    const RayPlan plan(surfaces, ray_caster, q, ray_count, streams);
    std::vector<Ray> rays(static_cast<std::size_t>(ray_count));
    parallel_for_ranges(rays.size(), batch_rays, [&](std::size_t begin, std::size_t end) {
        PointBlock points;
        plan.make_rays(static_cast<std::int64_t>(begin), std::span(rays).subspan(begin, end - begin), points);
    });
    return rays;
}

}  // namespace interflect
