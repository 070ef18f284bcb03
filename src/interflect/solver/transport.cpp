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

/// An element on the way down from a root, with what the oracle asks of it.
struct Visit {
    std::uint32_t element = none;
    Cell cell;
    Party party;
    Rgb radiosity{0, 0, 0};  // of the nearest element that was there when the step began: a new one inherits it
    float importance = 0;    // likewise
};

/// The state that a step starts from, and the way down the trees of the forest.
class Descent {
  public:
    Descent(ElementForest& forest, const TransportStep& step)
        : forest_(forest), step_(step), old_size_(forest.size()) {}

    std::uint32_t old_size() const { return old_size_; }

    Visit root(std::uint32_t patch) const {
        Visit v;
        v.party.normal = forest_.geometry(patch).normal();
        enter(v, patch, Cell());
        return v;
    }

    /// Goes to the child that holds p, if there is one. @return whether there was.
    bool go_down(Visit& v, Parameters p) const { return go_to(v, forest_.first_child(v.element), p); }

    /// The same; makes the children first where there are none.
    bool subdivide(Visit& v, Parameters p) const {
        const std::uint32_t child = forest_.first_child(v.element);
        return go_to(v, child == none ? forest_.subdivide(v.element) : child, p);
    }

    /// The leaf that holds p, an old element, above or below an element that holds it too.
    std::uint32_t old_leaf_at(const Visit& v, Parameters p) const {
        std::uint32_t e = v.element;
        if (e < old_size_) return forest_.leaf_below(e, v.cell, p, old_size_);
        while (e >= old_size_) e = forest_.parent(e);
        return e;
    }
    const ElementForest& forest() const { return forest_; }

  private:
    bool go_to(Visit& v, std::uint32_t first_child, Parameters p) const {
        if (first_child == none) return false;
        const bool triangle = forest_.geometry(forest_.patch(v.element)).is_triangle();
        const unsigned k = v.cell.child_at(p, triangle);
        enter(v, first_child + k, v.cell.child(k, triangle));
        return true;
    }

    void enter(Visit& v, std::uint32_t element, const Cell& cell) const {
        const PatchGeometry& geometry = forest_.geometry(forest_.patch(element));
        v.element = element;
        v.cell = cell;
        v.party.area = forest_.area(element);
        v.party.centre = geometry.point(cell.centre(geometry.is_triangle()));
        if (element >= old_size_) return;
        if (!step_.radiosity.empty()) v.radiosity = step_.radiosity[element];
        if (!step_.importance.empty()) v.importance = step_.importance[element];
    }

    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
};

/// Fills `way` with the elements that hold a leaf, from its root to itself.
void find_way_to_leaf(const Descent& descent, std::uint32_t leaf, std::vector<Visit>& way) {
    const ElementForest& forest = descent.forest();
    const std::uint32_t patch = forest.patch(leaf);
    const Parameters inside = forest.cell(leaf).centre(forest.geometry(patch).is_triangle());
    way.assign(1, descent.root(patch));
    while (way.back().element != leaf) {
        way.push_back(way.back());
        descent.go_down(way.back(), inside);
    }
}

/// Walks a pair of elements down from the roots until the oracle accepts it (Eq. 14, 15); the larger of the two is
/// divided.
/// @param way     Of the shooter, to the leaf that the ray starts on.
/// @param x, y    The parameters of the ray's two ends on their patches.
/// @param patch   That is hit. @return The element of it that receives.
Visit find_receiver(const Descent& descent, const Oracle& oracle, std::span<const Visit> way, Parameters x,
                    std::uint32_t patch, Parameters y, const Rgb& reflectance) {
    Visit shooter = way[0], receiver = descent.root(patch);
    std::size_t depth = 0;
    while (!oracle.accepts(shooter.party, receiver.party, reflectance * shooter.radiosity, receiver.importance)) {
        const bool divide_shooter = shooter.party.area > receiver.party.area;
        if ((divide_shooter ? shooter : receiver).party.area < 4 * oracle.smallest_area) break;
        if (!divide_shooter) {
            if (!descent.subdivide(receiver, y)) break;
        } else if (++depth < way.size()) {
            shooter = way[depth];
        } else if (!descent.subdivide(shooter, x)) {
            break;
        }
    }
    return receiver;
}

/// What one ray of each leaf carries, and all of them together.
struct Carried {
    std::vector<RgbD> power;         // [lm or W]; empty: none
    std::vector<double> importance;  // likewise
    RgbD all_power{0, 0, 0};
    double all_importance = 0;
};

Carried make_carried(const Surfaces& surfaces, const ElementForest& forest, const TransportStep& step,
                     const RayPlan& plan) {
    double q_sum = 0;
    for (const double w : step.q) q_sum += w;
    Carried carried;
    if (!step.radiosity.empty()) carried.power.resize(step.leaves.size(), RgbD(0));
    if (step.carries_importance) carried.importance.resize(step.leaves.size(), 0.0);
    for (std::size_t s = 0; s < step.leaves.size(); ++s) {
        if (plan.count(s) == 0) continue;
        const std::uint32_t leaf = step.leaves[s];
        const double area = forest.area(leaf) * (q_sum / static_cast<double>(step.rays) / step.q[s]);  // A_s / (N q_s)
        const auto count = static_cast<double>(plan.count(s));
        if (!carried.power.empty()) {
            carried.power[s] = step.quanta.empty() ? RgbD(step.radiosity[leaf]) * area : RgbD(step.quanta[s]);
            carried.all_power += carried.power[s] * count;
        }
        if (!carried.importance.empty()) {
            carried.importance[s] = surfaces.mean_reflectance(forest.patch(leaf)) * step.importance[leaf] * area;
            carried.all_importance += carried.importance[s] * count;
        }
    }
    return carried;
}

/// What arrives, as integers, so that the order of arrival does not matter.
struct Sums {
    FixedPoint power_unit, importance_unit;
    StableArray<FixedPoint::Value> power;
    StableArray<std::int64_t> importance;
    FixedPoint::Value escaped{};
    std::int64_t escaped_rays = 0;

    Sums(const Carried& carried, std::size_t capacity)
        : power_unit(channel_sum(carried.all_power)),
          importance_unit(carried.all_importance),
          power(carried.power.empty() ? 0 : capacity),
          importance(carried.importance.empty() ? 0 : capacity) {}
};

/// A tally of one task, added to the common sums at its end.
struct Tally {
    FixedPoint::Value escaped{};
    std::int64_t escaped_rays = 0;
};

/// One task's rays, hits and where what they carry arrives; one a thread, reused.
struct Batch {
    std::vector<Ray> rays = std::vector<Ray>(batch_rays);
    std::vector<Parameters> origins = std::vector<Parameters>(batch_rays);
    std::vector<Hit> hits = std::vector<Hit>(batch_rays);
    std::vector<Visit> way;
    std::vector<std::uint32_t> receivers, leaves;  // of power and of importance
    PointBlock points;
};

/// Everything that the receiving side of a step looks at.
struct Receiving {
    const Surfaces& surfaces;
    const Descent& descent;
    const TransportStep& step;
    const Carried& carried;
    Sums& sums;

    /// Hands what the rays of leaf number s, a part of the batch, bring to where they arrive. Sums are added to in a
    /// loop of their own: an atomic addition waits for all memory accesses under way, those of the walks down the
    /// trees.
    void operator()(std::size_t s, Batch& batch, std::size_t begin, std::size_t end, Tally& tally) const {
        find_receivers(s, batch, begin, end, tally);
        if (!carried.power.empty()) {
            const FixedPoint::Value power = sums.power_unit.from(carried.power[s]);
            for (const std::uint32_t e : batch.receivers) add_concurrently(sums.power[e], power);
            for (std::size_t c = 0; c < 3; ++c)
                tally.escaped[c] += static_cast<std::int64_t>(end - begin - batch.receivers.size()) * power[c];
        }
        if (carried.importance.empty()) return;
        const std::int64_t importance = sums.importance_unit.from(carried.importance[s]);
        for (const std::uint32_t e : batch.leaves) add_concurrently(sums.importance[e], importance);
    }

  private:
    void find_receivers(std::size_t s, Batch& batch, std::size_t begin, std::size_t end, Tally& tally) const {
        const ElementForest& forest = descent.forest();
        const bool refines = step.oracle.refines && !carried.power.empty();
        const bool needs_leaf = !refines || (step.carries_importance && !step.importance_at_patches);
        batch.receivers.clear();
        batch.leaves.clear();
        if (refines) find_way_to_leaf(descent, step.leaves[s], batch.way);
        for (std::size_t r = begin; r < end; ++r) {
            const std::uint32_t patch = batch.hits[r].patch;
            if (patch == none) {
                ++tally.escaped_rays;
                continue;
            }
            if (!refines && forest.is_leaf(patch)) {
                batch.receivers.push_back(patch);
                batch.leaves.push_back(patch);
                continue;
            }
            const Ray& ray = batch.rays[r];
            const Parameters y =
                forest.geometry(patch).parameters_of(ray.origin + batch.hits[r].distance * ray.direction);
            const Visit v = refines ? find_receiver(descent, step.oracle, batch.way, batch.origins[r], patch, y,
                                                    surfaces.reflectance(patch))
                                    : descent.root(patch);
            const std::uint32_t leaf = needs_leaf ? descent.old_leaf_at(v, y) : patch;
            batch.receivers.push_back(refines ? v.element : leaf);
            batch.leaves.push_back(step.importance_at_patches ? patch : leaf);
        }
    }
};

/// Puts what arrived at elements that have been renumbered where it belongs.
template <class T>
void renumber(StableArray<T>& sums, std::uint32_t first, const std::vector<std::uint32_t>& renumbered) {
    std::vector<T> moved(renumbered.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[renumbered[i] - first] = sums[first + i];
    for (std::size_t i = 0; i < moved.size(); ++i) sums[first + i] = moved[i];
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
    const bool carries_power = !step.radiosity.empty();
    received.irradiance.assign(carries_power ? forest.size() : 0, Rgb(0, 0, 0));
    received.importance.assign(step.carries_importance ? forest.size() : 0, 0.0f);
    if (std::all_of(step.q.begin(), step.q.end(), [](double w) { return w == 0; })) return received;

    const RayPlan plan(forest, ray_caster, step, streams);
    const Carried carried = make_carried(surfaces, forest, step, plan);
    Sums sums(carried, forest.capacity());
    const Descent descent(forest, step);
    const Receiving receive{surfaces, descent, step, carried, sums};
    tbb::enumerable_thread_specific<Batch> batches;
    parallel_for_ranges(static_cast<std::size_t>(step.rays), batch_rays, [&](std::size_t begin, std::size_t end) {
        Batch& batch = batches.local();
        const std::size_t count = end - begin;
        const std::span rays(batch.rays.data(), count);
        const std::span origins(batch.origins.data(), count);
        const std::span hits(batch.hits.data(), count);
        const auto first = static_cast<std::int64_t>(begin), last = static_cast<std::int64_t>(end);
        plan.make_rays(first, rays, origins, batch.points);
        ray_caster.trace(rays, hits);
        Tally tally;
        plan.for_each_source(first, last, [&](std::size_t s, std::int64_t from, std::int64_t to) {
            receive(s, batch, static_cast<std::size_t>(from - first), static_cast<std::size_t>(to - first), tally);
        });
        add_concurrently(sums.escaped, tally.escaped);
        add_concurrently(sums.escaped_rays, tally.escaped_rays);
    });

    streams.used.resize(std::max<std::size_t>(streams.used.size(), descent.old_size()), 0);
    for (std::size_t s = 0; s < step.leaves.size(); ++s)
        streams.used[step.leaves[s]] += static_cast<std::uint64_t>(plan.count(s));
    ++streams.allocations;

    const std::vector<std::uint32_t> renumbered = forest.put_in_order(descent.old_size());
    if (carries_power) {
        renumber(sums.power, descent.old_size(), renumbered);
        received.irradiance.resize(forest.size());
        for (std::uint32_t e = 0; e < forest.size(); ++e)
            received.irradiance[e] = Rgb(sums.power_unit.to_colour(sums.power[e])) / forest.area(e);
        push(forest, received.irradiance);
        pull(forest, received.irradiance);
        received.shot_power = carried.all_power;
        received.escaped_power = sums.power_unit.to_colour(sums.escaped);
    }
    if (step.carries_importance) {
        renumber(sums.importance, descent.old_size(), renumbered);
        received.importance.resize(forest.size());
        for (std::uint32_t e = 0; e < forest.size(); ++e)
            received.importance[e] =
                static_cast<float>(sums.importance_unit.to_number(sums.importance[e]) / forest.area(e));
        push(forest, received.importance);
        pull(forest, received.importance);
    }
    received.escaped_rays = sums.escaped_rays;
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
