#include "interflect/solver/transport.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <utility>

#include "interflect/base/fixed_point.h"
#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/carried.h"
#include "interflect/solver/gathering.h"
#include "interflect/solver/ray_allocation.h"
#include "interflect/solver/ray_maker.h"
#include "interflect/solver/receiving.h"
#include "interflect/solver/walks.h"

namespace interflect::inline detail {

namespace {

std::uint64_t walk_key(const SampleStreams& streams) {
    constexpr std::uint64_t purpose = 0x77616c6b;  // unique among random streams
    return mix(mix(streams.seed, purpose), streams.allocations);
}

/// Rays per task: many enough to amortise it, few enough for the second-level cache.
constexpr std::size_t batch_rays = 1024;
constexpr std::size_t rays_ahead = 32;

void advance(SampleStreams& streams, const RayAllocation& allocation, std::size_t elements, std::size_t parts) {
    constexpr std::size_t blocks_at_once = 16;
    streams.used.resize(std::max(streams.used.size(), elements), 0);
    streams.used_by_parts.resize(std::max(streams.used_by_parts.size(), parts), 0);
    parallel_for_ranges(allocation.block_count(), blocks_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                std::uint64_t& used = s < elements ? streams.used[s] : streams.used_by_parts[s - elements];
                used += static_cast<std::uint64_t>(next - first);
                return true;
            });
    });
    ++streams.allocations;
}

/// Upper bound of the visits of a random walk. The expected number is at most 1 / (1 - rho); the factor covers chance
/// and panes, and leaves 2^49 units for the expected power.
double most_visits(const Scene& scene) {
    constexpr double headroom = 0x1p12;
    double rho = 0;
    for (const Material& m : scene.materials) rho = std::max(rho, static_cast<double>(largest_channel(m.reflectance)));
    return headroom / (1 - rho);
}

/// Rays and payloads of a step. Refers to the step.
struct Shooting {
    Shooting(const Materials& materials, const ElementForest& forest, const RayCaster& ray_caster,
             const TransportStep& step, const SampleStreams& streams)
        : rays(forest, ray_caster, step, streams),
          carried(materials, forest, step, rays.allocation().q_sum()),
          all(all_carried(step, rays.allocation(), carried)),
          units(all, step.to_the_end ? most_visits(materials.scene()) : 1),
          panes(materials.scene(), ray_caster) {}

    RayMaker rays;
    Carried carried;
    Totals all;
    Units units;
    Panes panes;
};

/// Data of one task; one object per thread, reused.
struct Batch {
    explicit Batch(const Receiver& r) : receiver(r) {}

    RayBatch shot;
    std::vector<Hit> hits;
    std::vector<Panes::HitBehind> behind;
    std::vector<std::int64_t> group_terms;  // of one source
    Walkers walkers;
    Receiver receiver;
};

/// Contributions of a step after new elements (index >= old_size) were renumbered.
class Arrived {
  public:
    Arrived(Arrivals& arrivals, std::uint32_t old_size, std::vector<std::uint32_t> old_numbers)
        : arrivals_(arrivals), old_size_(old_size), old_numbers_(std::move(old_numbers)) {}

    Arrivals::Contribution take(std::uint32_t e) { return arrivals_.take(number(e)); }
    std::array<std::int64_t, 3> take(std::uint32_t e, std::size_t group) { return arrivals_.take(number(e), group); }
    void move(std::uint32_t from, std::uint32_t to) {
        arrivals_.add(number(to), take(from));
        for (std::size_t g = 0; g < arrivals_.groups(); ++g) arrivals_.add(number(to), g, take(from, g));
    }
    void release(std::size_t begin, std::size_t end) {
        if (end <= old_size_) arrivals_.release(begin, end);
    }

  private:
    std::uint32_t number(std::uint32_t e) const { return e < old_size_ ? e : old_numbers_[e - old_size_]; }

    Arrivals& arrivals_;
    std::uint32_t old_size_;
    std::vector<std::uint32_t> old_numbers_;
};

/// Drops elements beyond the oracle's limit. Their parents receive the contributions.
void drop_excess(ElementForest& forest, Arrived& arrived, std::size_t max_elements, std::uint32_t old_size) {
    while (forest.size() > std::max<std::size_t>(max_elements, old_size)) {
        const std::uint32_t first = forest.size() - 4, parent = forest.drop_last_siblings();
        for (std::uint32_t e = first; e < first + 4; ++e) arrived.move(e, parent);
    }
}

void forget_new_elements(ElementForest& forest, std::uint32_t old_size) {
    forest.put_in_order(old_size);
    while (forest.size() > old_size) forest.drop_last_siblings();
}

/// Returns nothing without importance, or if patches receive it and no luminaire shoots.
std::optional<GatheredImportance> gathered_by(const TransportStep& step, const Materials& materials,
                                              const ElementForest& forest) {
    if (!step.carries_importance() || (step.importance_at_patches && step.part_count() == 0)) return {};
    std::vector<double> largest((forest.size() + elements_at_once - 1) / elements_at_once, 0.0);
    parallel_for_ranges(forest.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        double& most = largest[begin / elements_at_once];
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e)
            most = std::max<double>(most, materials.mean_reflectance(forest.patch(e), e) * step.importance[e]);
    });
    const double hits = materials.has_panes() ? Panes::most_in_a_row + 1.0 : 1;  // hits per ray
    return std::optional<GatheredImportance>(std::in_place, hits * *std::max_element(largest.begin(), largest.end()),
                                             step.rays, forest.size() + step.part_count());
}

std::vector<PartImportance> found_by_parts(const TransportStep& step, const RayAllocation& allocation,
                                           const GatheredImportance& gathered, std::size_t elements) {
    std::vector<PartImportance> parts(step.part_count());
    for (std::size_t block = RayAllocation::block_of(elements); block < allocation.block_count(); ++block)
        allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
            if (s >= elements) parts[s - elements] = {gathered.sum(s), static_cast<double>(next - first)};
            return true;
        });
    return parts;
}

/// Averages the importance that a leaf received with that gathered by its own rays. A gathering ray has the weight 1,
/// and received importance the expected effective number of its rays. The weights do not depend on the estimates, so
/// the mean is unbiased.
void blend(const ElementForest& forest, const TransportStep& step, const RayAllocation& allocation,
           const GatheredImportance& gathered, const Totals& carried, std::size_t elements,
           std::vector<float>& received) {
    // Without incoming importance there is no incoming estimate.
    const double rays_per_importance = carried.importance > 0 ? carried.importance / carried.importance_square : 0;
    constexpr std::size_t blocks_at_once = 16;
    parallel_for_ranges(allocation.block_count(), blocks_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                if (s >= elements) return false;
                const auto leaf = static_cast<std::uint32_t>(s);
                const auto left = static_cast<double>(next - first);
                const double arrived = step.importance[leaf] * forest.area(leaf) * rays_per_importance;
                received[leaf] = static_cast<float>((arrived * received[leaf] + gathered.sum(leaf)) / (arrived + left));
                return true;
            });
    });
}

/// Converts sums of contributions to received values per area.
void collect(const ElementForest& forest, const TransportStep& step, const Units& units, Arrived& arrived,
             Received& received) {
    constexpr std::size_t at_once = std::size_t{1} << 16;  // sums fill more than a page of 2 MiB
    if (step.carries_power()) received.irradiance.resize(forest.size()), received.variance.resize(forest.size());
    if (step.carries_importance()) received.importance.resize(forest.size());
    received.groups.assign(step.groups.size(), std::vector<Rgb>(forest.size()));
    parallel_for_ranges(forest.size(), at_once, [&](std::size_t begin, std::size_t end) {
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            const auto [red, green, blue, square, importance] = arrived.take(e);
            const float area = forest.area(e);
            if (step.carries_power()) {
                received.irradiance[e] = Rgb(units.power.to_colour({red, green, blue})) / area;
                received.variance[e] = static_cast<float>(units.square.to_number(square) / area / area);
            }
            for (std::size_t g = 0; g < received.groups.size(); ++g)
                received.groups[g][e] = Rgb(units.power.to_colour(arrived.take(e, g))) / area;
            if (step.carries_importance())
                received.importance[e] = static_cast<float>(units.importance.to_number(importance) / area);
        }
        arrived.release(begin, end);
    });
}

void balance(const ElementForest& forest, const TransportStep& step, Received& received) {
    if (step.carries_power() && !step.leaves_only) {
        push(forest, received.irradiance), pull(forest, received.irradiance);
        push(forest, received.variance), pull_variance(forest, received.variance);
        for (std::vector<Rgb>& of_group : received.groups) push(forest, of_group), pull(forest, of_group);
    }
    if (step.carries_importance()) push(forest, received.importance), pull(forest, received.importance);
}

Received nothing_received(const TransportStep& step, std::size_t elements) {
    Received received;
    received.irradiance.assign(step.carries_power() ? elements : 0, Rgb(0));
    received.variance.assign(received.irradiance.size(), 0.0f);
    received.importance.assign(step.carries_importance() ? elements : 0, 0.0f);
    received.groups.assign(step.groups.size(), std::vector<Rgb>(elements, Rgb(0)));
    return received;
}

// The three phases of a step. After the second, Arrivals contain integers that several machines could sum.

void trace(const Shooting& shooting, const RayCaster& ray_caster, std::size_t begin, std::size_t end, Batch& batch) {
    shooting.rays.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), batch.shot);
    batch.hits.resize(batch.shot.rays.size());
    ray_caster.trace(batch.shot.rays, batch.hits);
    shooting.panes.trace(batch.shot.rays, batch.hits, batch.behind);
}

/// Deposits the filtered payload of rays behind panes.
void receive_behind(const TransportStep& step, const Shooting& shooting, const SourceRays& rays,
                    std::span<const Panes::HitBehind> behind, Batch& batch) {
    const std::uint32_t source = rays.source;
    for (const auto& [ray, transmittance, hit] : behind) {
        shooting.units.add_groups(step, shooting.carried, source, batch.group_terms, transmittance);
        batch.receiver.take(source, shooting.units.contribution(step, shooting.carried, source, transmittance),
                            batch.group_terms, std::span(batch.shot.rays).subspan(ray, 1),
                            std::span(batch.shot.origins).subspan(ray, 1), std::span(&hit, 1),
                            channel_sum(transmittance) / 3);
    }
}

/// Deposits the payload of a batch; the oracle may create elements.
void receive(const TransportStep& step, const Shooting& shooting, Batch& batch) {
    auto& [shot, hits, all_behind, group_terms, walkers, receiver] = batch;
    std::span<const Panes::HitBehind> behind = all_behind;
    std::size_t fetched = 0;
    for (const SourceRays& rays : shot.sources) {
        const auto [source, first, last] = rays;
        const std::size_t fetch = std::min<std::size_t>(last + rays_ahead, hits.size()), count = last - first;
        for (; fetched < fetch; ++fetched) receiver.prefetch(hits[fetched]);
        shooting.units.add_groups(step, shooting.carried, source, group_terms);
        receiver.take(source, shooting.units.contribution(step, shooting.carried, source), group_terms,
                      std::span(shot.rays).subspan(first, count), std::span(shot.origins).subspan(first, count),
                      std::span(hits).subspan(first, count));
        const auto of_others =
            std::find_if(behind.begin(), behind.end(), [last = last](const auto& b) { return b.ray >= last; });
        const auto own = static_cast<std::size_t>(of_others - behind.begin());
        receive_behind(step, shooting, rays, behind.first(own), batch);
        behind = behind.subspan(own);
    }
    receiver.finish_batch();
}

/// Continues a batch as random walks. @param task  Index of the first ray.
void walk(const TransportStep& step, const Shooting& shooting, const Walks& walks, std::uint64_t task, Batch& batch) {
    Walkers& walkers = batch.walkers;
    const auto add = [&](std::uint32_t source, std::uint32_t ray, const Hit& hit, const Rgb& transmittance) {
        if (hit.patch == none) return;
        walks.add(batch.shot.rays[ray], hit, shooting.carried.power(source), transmittance, walkers);
        for (std::size_t g = 0; g < step.groups.size(); ++g)
            walkers.received_groups.push_back(shooting.carried.power(source, g) * RgbD(transmittance));
    };
    auto behind = batch.behind.begin();
    for (const auto [source, first, last] : batch.shot.sources) {
        for (std::uint32_t ray = first; ray < last; ++ray) add(source, ray, batch.hits[ray], Rgb(1));
        for (; behind != batch.behind.end() && behind->ray < last; ++behind)
            add(source, behind->ray, behind->hit, behind->transmittance);
    }
    walks.follow(task, walkers, batch.receiver);
}

/// Joins the points of all threads, in any order.
StartPoints start_points_of(const std::vector<std::vector<StartPoint>>& of_threads) {
    std::vector<StartPoint> all;
    for (const std::vector<StartPoint>& some : of_threads) all.insert(all.end(), some.begin(), some.end());
    return StartPoints(std::move(all));
}

/// Converts contributions to received values. @param step  Its buffers are reused.
Received commit(TransportStep& step, const Shooting& shooting, ElementForest& forest, SampleStreams& streams,
                Arrivals& arrivals, const std::optional<GatheredImportance>& gathered, const Escaped& escaped) {
    const RayAllocation& allocation = shooting.rays.allocation();
    const std::uint32_t old_size = shooting.rays.elements();
    advance(streams, allocation, old_size, step.part_count());
    Arrived arrived(arrivals, old_size, forest.put_in_order(old_size));
    drop_excess(forest, arrived, step.oracle.max_elements, old_size);
    Received received;
    step.oracle.importance = std::vector<float>();
    if (!gathered) step.q = std::vector<float>();
    if (step.spent) received.irradiance = std::move(*step.spent);
    collect(forest, step, shooting.units, arrived, received);
    if (gathered && !step.importance_at_patches)
        blend(forest, step, allocation, *gathered, shooting.all, old_size, received.importance);
    if (gathered) received.part_importance = found_by_parts(step, allocation, *gathered, old_size);
    balance(forest, step, received);
    received.shot_power = shooting.all.power;
    received.quanta = shooting.all.quanta;
    received.escaped_rays = escaped.rays;
    received.escaped_power = shooting.units.power.to_colour(escaped.power);
    if (step.emission) {
        received.shot_power -= step.emission->repeated_power();
        received.escaped_power -= step.emission->repeated_power();
    }
    return received;
}

}  // namespace

Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop) {
    assert(step.q.size() == forest.size() + step.part_count() && step.rays > 0);
    const Shooting shooting(materials, forest, ray_caster, step, streams);
    const std::uint32_t old_size = forest.size();
    if (!(shooting.rays.allocation().q_sum() > 0)) return nothing_received(step, old_size);

    arrivals.begin(old_size);
    std::optional<GatheredImportance> gathered = gathered_by(step, materials, forest);
    const Walks walks(materials, forest, ray_caster, shooting.panes, step, shooting.units, old_size, walk_key(streams));
    PerThread<Batch> batches([&] {
        return Batch({materials, forest, step, old_size, arrivals, gathered ? &*gathered : nullptr});
    });
    try {
        parallel_for_ranges(static_cast<std::size_t>(step.rays), batch_rays, stop,
                            [&](std::size_t begin, std::size_t end) {
                                Batch& batch = batches.local();
                                trace(shooting, ray_caster, begin, end, batch);
                                receive(step, shooting, batch);
                                if (step.to_the_end) walk(step, shooting, walks, begin, batch);
                            });
    } catch (const Interrupted&) {
        arrivals.clear(forest.size());
        forget_new_elements(forest, old_size);
        throw;
    }
    Escaped escaped;
    std::vector<std::vector<StartPoint>> start_points;
    for (Batch& batch : batches) {
        escaped += batch.receiver.finish();
        start_points.push_back(batch.receiver.start_points());
    }
    Received received = commit(step, shooting, forest, streams, arrivals, gathered, escaped);
    received.start_points = start_points_of(start_points);
    return received;
}

Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams) {
    Arrivals arrivals(forest.capacity(), step.groups.size());
    return transport(materials, forest, ray_caster, std::move(step), streams, arrivals, StopRequest());
}

std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams) {
    const RayMaker maker(forest, ray_caster, step, streams);
    std::vector<Ray> rays(static_cast<std::size_t>(step.rays));
    parallel_for_ranges(rays.size(), batch_rays, [&](std::size_t begin, std::size_t end) {
        RayBatch batch;
        maker.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), batch);
        std::copy(batch.rays.begin(), batch.rays.end(), rays.begin() + static_cast<std::ptrdiff_t>(begin));
    });
    return rays;
}

}  // namespace interflect::inline detail
