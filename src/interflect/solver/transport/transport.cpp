#include "interflect/solver/transport/transport.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <utility>

#include "interflect/base/numbers/fixed_point.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/numbers/ranked_bits.h"
#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/deposit/descent.h"
#include "interflect/solver/deposit/found_importance.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/ray_allocation.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/transport/walks.h"

namespace interflect::detail {

namespace {

/// Returns the elements that can receive contributions. Returns an empty set if all elements can, or if there are few.
RankedBits receivers(const ElementForest& forest, const TransportStep& step) {
    const bool only_leaves = !(step.oracle.refines && step.carries_power()) && !step.importance_at_patches;
    if (!only_leaves || forest.size() < many_elements) return {};
    return RankedBits(forest.size(), [&](std::uint32_t e) { return forest.is_leaf(ElementIndex(e)); });
}

std::uint64_t walk_key(const SampleStreams& streams) {
    constexpr std::uint64_t walk_stream = 0x77616c6b;  // "walk" in ASCII
    return mix(mix(streams.seed, walk_stream), streams.allocations);
}

/// Number of rays of a batch: enough to amortise the cost of a task, few enough for the second-level cache.
constexpr std::size_t batch_rays = 1024;
/// Number of hits between the prefetch of a patch and the deposit on it, to hide the memory latency.
constexpr std::size_t prefetch_distance = 32;

/// Returns an upper bound of the number of deposits: the expected number, at most 1 / (1 - rho), times a margin for
/// random deviations and panes. The expected sum then uses 2^49 of the 2^61 units of FixedPoint.
double max_deposits_per_particle(const Scene& scene) {
    constexpr double margin = 0x1p12;
    double rho = 0;
    for (const Material& m : scene.materials) rho = std::max(rho, static_cast<double>(largest_channel(m.reflectance)));
    return margin / (1 - rho);
}

/// Data of a step that all threads read.
struct StepData {
    StepData(const Materials& materials, const ElementForest& forest, const RayCaster& ray_caster,
             const TransportStep& step, const SampleStreams& streams)
        : rays(forest, ray_caster, step, streams),
          payload(materials, forest, step, rays.allocation().q_sum()),
          payload_totals(total_payload(step, rays.allocation(), payload)),
          contribution_units(payload_totals,
                             step.completes_by_walks ? max_deposits_per_particle(materials.scene()) : 1),
          panes(materials.scene(), ray_caster) {}

    RayMaker rays;
    Payload payload;
    PayloadTotals payload_totals;
    ContributionUnits contribution_units;
    Panes panes;
};

struct ThreadBuffers {
    explicit ThreadBuffers(const Descent& d) : descent(d) {}

    RayBatch ray_batch;
    std::vector<Hit> hits;
    std::vector<Panes::HitBehind> behind;
    std::vector<std::int64_t> group_terms;
    Walkers walkers;
    Descent descent;
};

void drop_new_elements(ElementForest& forest, std::uint32_t old_size) {
    forest.put_in_order(old_size);  // parents then precede their children
    while (forest.size() > old_size) forest.drop_last_siblings();
}

/// Makes sums of the importance at the hits of each source's rays. Returns nullopt if they are not needed: without
/// importance, or if it is deposited at patches and no luminaire part shoots.
std::optional<FoundImportance> make_found_importance(const TransportStep& step, const Materials& materials,
                                                     const ElementForest& forest) {
    if (!step.carries_importance() || (step.importance_at_patches && step.part_count() == 0)) return {};
    std::vector<double> largest((forest.size() + elements_per_task - 1) / elements_per_task, 0.0);
    parallel_for_ranges(forest.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        double& most = largest[begin / elements_per_task];
        for (ElementIndex e(begin); e < end; ++e)
            most = std::max<double>(most, materials.mean_reflectance(forest.patch(e), e) * step.importance[e]);
    });
    const double max_hits_per_ray = materials.has_panes() ? Panes::max_consecutive_panes + 1.0 : 1;
    return std::optional<FoundImportance>(std::in_place,
                                          max_hits_per_ray * *std::max_element(largest.begin(), largest.end()),
                                          step.rays, forest.size() + step.part_count());
}

void trace(const StepData& data, const RayCaster& ray_caster, std::size_t begin, std::size_t end,
           ThreadBuffers& buffers) {
    data.rays.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), buffers.ray_batch);
    buffers.hits.resize(buffers.ray_batch.rays.size());
    ray_caster.trace(buffers.ray_batch.rays, buffers.hits);
    data.panes.trace(buffers.ray_batch.rays, buffers.hits, buffers.behind);
}

void deposit_behind_panes(const TransportStep& step, const StepData& data, std::uint32_t source,
                          std::span<const Panes::HitBehind> behind, ThreadBuffers& buffers) {
    for (const auto& [ray, transmittance, hit] : behind) {
        const float mean_transmittance = channel_sum(transmittance) / 3;
        data.contribution_units.fill_groups(step, data.payload, source, buffers.group_terms, transmittance);
        buffers.descent.deposit(source, data.contribution_units.contribution(step, data.payload, source, transmittance),
                                buffers.group_terms, std::span(buffers.ray_batch.rays).subspan(ray, 1),
                                std::span(buffers.ray_batch.origins).subspan(ray, 1), std::span(&hit, 1),
                                mean_transmittance);
    }
}

void deposit(const TransportStep& step, const StepData& data, ThreadBuffers& buffers) {
    auto& [ray_batch, hits, all_behind, group_terms, walkers, descent] = buffers;
    std::span<const Panes::HitBehind> behind = all_behind;
    std::size_t prefetched = 0;
    for (const auto [source, begin, end] : ray_batch.sources) {
        const std::size_t prefetch_end = std::min<std::size_t>(end + prefetch_distance, hits.size());
        for (; prefetched < prefetch_end; ++prefetched) descent.prefetch(hits[prefetched]);
        const std::size_t ray_count = end - begin;
        data.contribution_units.fill_groups(step, data.payload, source, group_terms);
        descent.deposit(source, data.contribution_units.contribution(step, data.payload, source), group_terms,
                        std::span(ray_batch.rays).subspan(begin, ray_count),
                        std::span(ray_batch.origins).subspan(begin, ray_count),
                        std::span(hits).subspan(begin, ray_count));
        const auto end_of_source =
            std::find_if(behind.begin(), behind.end(), [end = end](const auto& b) { return b.ray >= end; });
        const auto count = static_cast<std::size_t>(end_of_source - behind.begin());
        deposit_behind_panes(step, data, source, behind.first(count), buffers);
        behind = behind.subspan(count);
    }
    descent.finish_task();
}

/// Continues the hits of a batch by random walks. @param first_ray  First ray of the batch, a key of the random
/// numbers.
void walk(const TransportStep& step, const StepData& data, const Walks& walks, std::uint64_t first_ray,
          ThreadBuffers& buffers) {
    Walkers& walkers = buffers.walkers;
    const auto add = [&](std::uint32_t source, std::uint32_t ray, const Hit& hit, const Rgb& transmittance) {
        if (hit.patch == none) return;
        walks.add(buffers.ray_batch.rays[ray], hit, data.payload.power(source), transmittance, walkers);
        for (std::size_t g = 0; g < step.groups.size(); ++g)
            walkers.received_groups.push_back(data.payload.power(source, g) * RgbD(transmittance));
    };
    auto behind = buffers.behind.begin();
    for (const auto [source, begin, end] : buffers.ray_batch.sources) {
        for (std::uint32_t ray = begin; ray < end; ++ray) add(source, ray, buffers.hits[ray], Rgb(1));
        for (; behind != buffers.behind.end() && behind->ray < end; ++behind)
            add(source, behind->ray, behind->hit, behind->transmittance);
    }
    walks.follow(first_ray, walkers, buffers.descent);
}

/// Calls body(begin, end) for the batches of rays of this rank. The ranks take turns, which balances the work.
/// @throws Interrupted if `stop` is due before the last batch.
template <class Body>
void for_batches_of_rank(std::size_t rays, const CommonStop& stop, const Body& body) {
    const Ranks* const ranks = stop.ranks();
    if (!ranks) return parallel_for_ranges(rays, batch_rays, stop.within_process(), body);
    constexpr std::size_t rays_of_rank =
        4096 * batch_rays;  // some seconds of work, after which rank 0 may stop all ranks
    const std::size_t at_once = rays_of_rank * static_cast<std::size_t>(ranks->count());
    for (std::size_t first = 0; first < rays; first += at_once) {
        if (stop.is_due()) throw Interrupted();
        parallel_for_own_ranges(ranks, std::min(at_once, rays - first), batch_rays,
                                [&](std::size_t begin, std::size_t end) { body(first + begin, first + end); });
    }
}

/// Adds the elements that other ranks have made in this step. Elements from `old_size` on are new.
void make_elements_of_ranks(Ranks& ranks, ElementForest& forest, std::uint32_t old_size) {
    struct Parent {
        PatchIndex patch;
        std::uint32_t path;
    };
    std::vector<Parent> divided;
    for (ElementIndex e(old_size); e < forest.size(); e += 4)
        divided.push_back({forest.patch(e), forest.path(forest.parent(e))});
    divided = gather_over_ranks<Parent>(ranks, divided);
    // Parents have shorter and hence smaller paths than their children, so sort by path.
    std::ranges::sort(divided, {}, [](const Parent& p) { return std::pair(p.path, p.patch); });
    for (const Parent& p : divided) {
        const ElementIndex element = forest.at_path(p.patch, p.path);
        if (element != none && forest.is_leaf(element)) forest.subdivide(element);
    }
}

Escaped sum_over_ranks(Ranks& ranks, const Escaped& own) {
    Escaped sum;
    for (const Escaped& of_rank : gather_over_ranks<Escaped>(ranks, std::span(&own, 1))) sum += of_rank;
    return sum;
}

}  // namespace

Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, ContributionSums& sums, const CommonStop& stop) {
    assert(step.q.size() == forest.size() + step.part_count() && step.rays > 0);
    const StepData data(materials, forest, ray_caster, step, streams);
    const std::uint32_t old_size = forest.size();
    if (!(data.rays.allocation().q_sum() > 0)) return nothing_received(step, old_size);

    // Trace batches of rays, and deposit their payloads
    sums.begin_step(old_size, step.carries_importance(), receivers(forest, step));
    std::optional<FoundImportance> found_importance = make_found_importance(step, materials, forest);
    const Walks walks(materials, forest, ray_caster, data.panes, step, data.contribution_units, old_size,
                      walk_key(streams));
    PerThread<ThreadBuffers> all_buffers([&] {
        return ThreadBuffers(
            {materials, forest, step, old_size, sums, found_importance ? &*found_importance : nullptr});
    });
    try {
        for_batches_of_rank(static_cast<std::size_t>(step.rays), stop, [&](std::size_t begin, std::size_t end) {
            ThreadBuffers& buffers = all_buffers.local();
            trace(data, ray_caster, begin, end, buffers);
            deposit(step, data, buffers);
            if (step.completes_by_walks) walk(step, data, walks, begin, buffers);
        });
    } catch (const Interrupted&) {
        sums.clear(forest.size());
        drop_new_elements(forest, old_size);
        throw;
    }

    // Combine the results of threads and ranks
    Escaped escaped;
    std::vector<const std::vector<StartPoint>*> start_points;
    for (ThreadBuffers& buffers : all_buffers) {
        escaped += buffers.descent.finish();
        start_points.push_back(&buffers.descent.start_points());
    }
    std::vector<StartPoint> start_points_of_ranks;
    if (stop.ranks()) {
        make_elements_of_ranks(*stop.ranks(), forest, old_size);
        if (found_importance) add_over_ranks(*stop.ranks(), found_importance->size(), *found_importance);
        std::vector<StartPoint> own;
        for (const std::vector<StartPoint>* of_thread : start_points)
            own.insert(own.end(), of_thread->begin(), of_thread->end());
        start_points_of_ranks = gather_over_ranks<StartPoint>(*stop.ranks(), own);
        start_points = {&start_points_of_ranks};
        escaped = sum_over_ranks(*stop.ranks(), escaped);
    }

    // Convert the contributions to irradiance and importance
    const RayAllocation& allocation = data.rays.allocation();
    advance(streams, allocation, old_size, step.part_count());
    Received received = collect(step, forest, old_size, allocation, data.payload_totals, data.contribution_units,
                                found_importance ? &*found_importance : nullptr, sums, stop.ranks());
    received.start_points = StartPoints(start_points, old_size);
    received.escaped_rays = escaped.rays;
    received.escaped_power = data.contribution_units.power.to_colour(escaped.power);
    // Skies and suns send rays through the box of the scene and through the boxes of targets within it (Emission). Each
    // line is sampled from one box only, so the power of the scene's box includes the power of targets.
    if (step.emission) {
        received.shot_power -= step.emission->repeated_power();
        received.escaped_power -= step.emission->repeated_power();
    }
    return received;
}

Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams) {
    ContributionSums sums(forest.capacity(), step.groups.size());
    return transport(materials, forest, ray_caster, std::move(step), streams, sums, CommonStop());
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

}  // namespace interflect::detail
