#include "interflect/solver/transport.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "interflect/base/fixed_point.h"
#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/ray_source.h"
#include "interflect/solver/receiving.h"

namespace interflect {

namespace {

/// Rays of one task: enough to hide the cost of a task, few enough to stay in the second-level cache.
constexpr std::size_t batch_rays = 4096;
/// Rays whose receivers are looked for side by side: what is known of them fits into the first-level cache.
constexpr std::size_t group_rays = 128;

/// Keys of the random numbers, so that no two purposes share one.
enum class Purpose : std::uint64_t { allocation = 1, sampling = 2 };

std::uint64_t stream_key(const SampleStreams& streams, Purpose purpose, std::uint64_t index) {
    return mix(mix(streams.seed, static_cast<std::uint64_t>(purpose)), index);
}

/// Which rays start where: those of leaf number s are first_ray[s] ... first_ray[s + 1] - 1.
class RayPlan {
  public:
    RayPlan(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
            const SampleStreams& streams)
        : forest_(forest), step_(step), streams_(streams), lift_(ray_caster.lift()) {
        const std::uint64_t key = stream_key(streams, Purpose::allocation, 0);
        first_ray_ = allocate_rays(step.q, step.rays, random_double(key, streams.allocations));
    }

    std::int64_t count(std::size_t s) const { return first_ray_[s + 1] - first_ray_[s]; }

    /// Calls body(s, from, to) for every leaf number s that has rays in [begin, end): those from ... to - 1.
    template <class Body>
    void for_each_source(std::int64_t begin, std::int64_t end, const Body& body) const {
        const auto after = std::upper_bound(first_ray_.begin(), first_ray_.end(), begin);
        auto s = static_cast<std::size_t>(after - first_ray_.begin() - 1);
        for (std::int64_t from = begin; from < end; ++s) {
            const std::int64_t to = std::min(first_ray_[s + 1], end);
            if (to > from) body(s, from, to);
            from = to;
        }
    }

    /// Makes the rays begin ... begin + rays.size() - 1.
    void make_rays(std::int64_t begin, std::span<Ray> rays, std::span<Parameters> origins, PointBlock& points) const {
        const auto end = begin + static_cast<std::int64_t>(rays.size());
        for_each_source(begin, end, [&](std::size_t s, std::int64_t from, std::int64_t to) {
            const std::uint32_t leaf = step_.leaves[s], patch = forest_.patch(leaf);
            const std::uint64_t place = std::uint64_t{patch} << 32 | forest_.path(leaf);
            const std::uint64_t used = leaf < streams_.used.size() ? streams_.used[leaf] : 0;
            const auto offset = static_cast<std::size_t>(from - begin), length = static_cast<std::size_t>(to - from);
            shoot_rays(forest_.geometry(patch), forest_.cell(leaf), lift_, streams_.points,
                       stream_key(streams_, Purpose::sampling, place),
                       used + static_cast<std::uint64_t>(from - first_ray_[s]), points, rays.subspan(offset, length),
                       origins.subspan(offset, length));
        });
    }

  private:
    const ElementForest& forest_;
    const TransportStep& step_;
    const SampleStreams& streams_;
    float lift_;
    std::vector<std::int64_t> first_ray_;
};

/// What one ray of each leaf carries: A_s / (N q_s) of the leaf's radiosity and of its reflected importance.
class Carried {
  public:
    Carried(const Surfaces& surfaces, const ElementForest& forest, const TransportStep& step)
        : surfaces_(surfaces),
          forest_(forest),
          step_(step),
          q_sum_over_rays_(std::accumulate(step.q.begin(), step.q.end(), 0.0) / static_cast<double>(step.rays)) {}

    RgbD power(std::size_t s) const {
        if (!step_.quanta.empty()) return RgbD(step_.quanta[s]);
        return RgbD(step_.radiosity[step_.leaves[s]]) * area_per_ray(s);
    }
    double importance(std::size_t s) const {
        const std::uint32_t leaf = step_.leaves[s];
        return surfaces_.mean_reflectance(forest_.patch(leaf)) * step_.importance[leaf] * area_per_ray(s);
    }

  private:
    double area_per_ray(std::size_t s) const { return forest_.area(step_.leaves[s]) * (q_sum_over_rays_ / step_.q[s]); }

    const Surfaces& surfaces_;
    const ElementForest& forest_;
    const TransportStep& step_;
    double q_sum_over_rays_;
};

/// The units in which arrivals are counted: what all rays carry fits.
struct Units {
    RgbD all_power{0, 0, 0};  ///< Of all rays together [lm or W].
    FixedPoint power{0}, importance{0};

    Units(const TransportStep& step, const RayPlan& plan, const Carried& carried) {
        double all_importance = 0;
        for (std::size_t s = 0; s < step.leaves.size(); ++s) {
            const auto count = static_cast<double>(plan.count(s));
            if (count == 0) continue;
            if (step.carries_power()) all_power += carried.power(s) * count;
            if (step.carries_importance) all_importance += carried.importance(s) * count;
        }
        power = FixedPoint(channel_sum(all_power));
        importance = FixedPoint(all_importance);
    }
};

std::vector<Arrivals::Load> make_loads(const TransportStep& step, const RayPlan& plan, const Carried& carried,
                                       const Units& units) {
    std::vector<Arrivals::Load> loads(step.leaves.size(), Arrivals::Load{});
    for (std::size_t s = 0; s < loads.size(); ++s) {
        if (plan.count(s) == 0) continue;
        if (step.carries_power()) {
            const FixedPoint::Value power = units.power.from(carried.power(s));
            std::copy(power.begin(), power.end(), loads[s].begin());
        }
        if (step.carries_importance) loads[s][3] = units.importance.from(carried.importance(s));
    }
    return loads;
}

/// One task's rays and hits, and what becomes of them; one a thread, reused.
struct Batch {
    explicit Batch(const Receiver& r) : receiver(r) {}

    std::vector<Ray> rays = std::vector<Ray>(batch_rays);
    std::vector<Parameters> origins = std::vector<Parameters>(batch_rays);
    std::vector<Hit> hits = std::vector<Hit>(batch_rays);
    PointBlock points;
    Receiver receiver;
};

/// Puts what arrived at elements that have been renumbered where it belongs.
void renumber(Arrivals& arrivals, std::uint32_t first, const std::vector<std::uint32_t>& renumbered) {
    std::vector<Arrivals::Load> moved(renumbered.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[renumbered[i] - first] = arrivals[first + i];
    for (std::size_t i = 0; i < moved.size(); ++i) arrivals[first + i] = moved[i];
}

/// Keeps the forest within the oracle's limit; what arrived at elements that are dropped arrives at their parents.
void drop_excess(ElementForest& forest, Arrivals& arrivals, std::size_t most_elements, std::uint32_t old_size) {
    while (forest.size() > std::max<std::size_t>(most_elements, old_size)) {
        const std::uint32_t first = forest.size() - 4, parent = forest.drop_last_siblings();
        for (std::uint32_t e = first; e < first + 4; ++e)
            for (std::size_t c = 0; c < arrivals[e].size(); ++c) arrivals[parent][c] += arrivals[e][c];
    }
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

Received transport(const Surfaces& surfaces, ElementForest& forest, const RayCaster& ray_caster,
                   const TransportStep& step, SampleStreams& streams) {
    assert(step.q.size() == step.leaves.size() && step.rays > 0);
    Received received;
    received.irradiance.assign(step.carries_power() ? forest.size() : 0, Rgb(0, 0, 0));
    received.importance.assign(step.carries_importance ? forest.size() : 0, 0.0f);
    if (std::all_of(step.q.begin(), step.q.end(), [](double w) { return w == 0; })) return received;

    const RayPlan plan(forest, ray_caster, step, streams);
    const Carried carried(surfaces, forest, step);
    const Units units(step, plan, carried);
    Arrivals arrivals(make_loads(step, plan, carried, units), forest.size(), forest.capacity());
    const Descent descent(forest, step);
    tbb::enumerable_thread_specific<Batch> batches([&] { return Batch({surfaces, descent, step, arrivals}); });
    parallel_for_ranges(static_cast<std::size_t>(step.rays), batch_rays, [&](std::size_t begin, std::size_t end) {
        Batch& batch = batches.local();
        const std::span rays(batch.rays.data(), end - begin);
        const std::span origins(batch.origins.data(), rays.size());
        const std::span hits(batch.hits.data(), rays.size());
        plan.make_rays(static_cast<std::int64_t>(begin), rays, origins, batch.points);
        ray_caster.trace(rays, hits);
        for (std::size_t group = begin; group < end; group += group_rays) {
            const auto first = static_cast<std::int64_t>(group);
            const auto last = static_cast<std::int64_t>(std::min(end, group + group_rays));
            plan.for_each_source(first, last, [&](std::size_t s, std::int64_t from, std::int64_t to) {
                const std::size_t offset = static_cast<std::size_t>(from) - begin;
                const auto count = static_cast<std::size_t>(to - from);
                batch.receiver.take(static_cast<std::uint32_t>(s), rays.subspan(offset, count),
                                    origins.subspan(offset, count), hits.subspan(offset, count));
            });
            batch.receiver.finish_group();
        }
    });
    Escaped escaped;
    for (Batch& batch : batches) {
        const Escaped e = batch.receiver.finish();
        for (std::size_t c = 0; c < 3; ++c) escaped.power[c] += e.power[c];
        escaped.rays += e.rays;
    }

    streams.used.resize(std::max<std::size_t>(streams.used.size(), descent.old_size()), 0);
    for (std::size_t s = 0; s < step.leaves.size(); ++s)
        streams.used[step.leaves[s]] += static_cast<std::uint64_t>(plan.count(s));
    ++streams.allocations;

    renumber(arrivals, descent.old_size(), forest.put_in_order(descent.old_size()));
    drop_excess(forest, arrivals, step.oracle.most_elements, descent.old_size());
    if (step.carries_power()) {
        received.irradiance.resize(forest.size());
        for (std::uint32_t e = 0; e < forest.size(); ++e) {
            const auto& [red, green, blue, importance] = arrivals[e];
            received.irradiance[e] = Rgb(units.power.to_colour({red, green, blue})) / forest.area(e);
        }
        push(forest, received.irradiance);
        pull(forest, received.irradiance);
        received.shot_power = units.all_power;
        received.escaped_power = units.power.to_colour(escaped.power);
    }
    if (step.carries_importance) {
        received.importance.resize(forest.size());
        for (std::uint32_t e = 0; e < forest.size(); ++e)
            received.importance[e] = static_cast<float>(units.importance.to_number(arrivals[e][3]) / forest.area(e));
        push(forest, received.importance);
        pull(forest, received.importance);
    }
    received.escaped_rays = escaped.rays;
    return received;
}

std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams) {
    const RayPlan plan(forest, ray_caster, step, streams);
    std::vector<Ray> rays(static_cast<std::size_t>(step.rays));
    std::vector<Parameters> origins(rays.size());
    parallel_for_ranges(rays.size(), batch_rays, [&](std::size_t begin, std::size_t end) {
        PointBlock points;
        plan.make_rays(static_cast<std::int64_t>(begin), std::span(rays).subspan(begin, end - begin),
                       std::span(origins).subspan(begin, end - begin), points);
    });
    return rays;
}

}  // namespace interflect
