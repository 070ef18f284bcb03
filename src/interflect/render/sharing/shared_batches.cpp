#include "interflect/render/sharing/shared_batches.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "interflect/base/threads/shared_ranges.h"
#include "interflect/render/sharing/broadcast.h"

namespace interflect::detail {

std::size_t SharedBatches::paths_at_once(const PathPlan& plan, const Ranks* ranks) {
    constexpr std::size_t paths_of_process = std::size_t{1} << 19;
    return paths_of_process * (ranks && !plan.hybrid ? static_cast<std::size_t>(ranks->count()) : 1);
}

RayCounts SharedBatches::trace(std::span<SampleBatch> batches, const std::function<bool()>& is_over, bool is_limited) {
    if (ranks_) {
        Chunk chunk{.batches = batches.size(), .light_set = light_set_, .is_limited = is_limited};
        broadcast(*ranks_, std::span(&chunk, 1));
        std::vector<Key> keys;
        keys.reserve(batches.size());
        for (const SampleBatch& b : batches) keys.push_back({b.pixel, b.number, b.first_index, b.half_size, b.tracing});
        broadcast(*ranks_, std::span(keys));
    }
    return trace_own(batches, is_over);
}

void SharedBatches::predict_by(int width, int height, std::vector<NearbyLight::Sample> samples) {
    if (ranks_) {
        Chunk chunk{.width = width, .height = height};
        broadcast(*ranks_, std::span(&chunk, 1));
        broadcast(*ranks_, std::span(samples));
    }
    nearby_.emplace(width, height, std::move(samples));
}

void SharedBatches::receive_prediction(int width, int height) {
    std::vector<NearbyLight::Sample> samples(2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    broadcast(*ranks_, std::span(samples));
    nearby_.emplace(width, height, std::move(samples));
}

std::int64_t SharedBatches::renew_virtual_lights() {
    if (!virtual_lights_) return 0;
    const std::int64_t before = virtual_lights_->rays();
    virtual_lights_->renew(++light_set_);
    return virtual_lights_->rays() - before;
}

void SharedBatches::end() {
    if (!ranks_) return;
    Chunk chunk;
    broadcast(*ranks_, std::span(&chunk, 1));
    ranks_->gather({});
}

void SharedBatches::help(const StopRequest& time_left) {
    std::vector<Key> keys;
    for (;;) {
        Chunk chunk;
        broadcast(*ranks_, std::span(&chunk, 1));
        if (chunk.width > 0) {
            receive_prediction(chunk.width, chunk.height);
            continue;
        }
        if (chunk.batches == 0) break;
        keys.resize(chunk.batches);
        broadcast(*ranks_, std::span(keys));
        if (chunk.light_set != light_set_) virtual_lights_->renew(light_set_ = chunk.light_set);
        std::vector<SampleBatch> batches;
        batches.reserve(keys.size());
        for (const Key& k : keys) batches.push_back({k.pixel, k.number, k.first_index, k.size, k.tracing});
        trace_own(batches, [&] { return chunk.is_limited && time_left.is_out_of_time(); });
    }
    ranks_->gather({});
}

RayCounts SharedBatches::trace_own(std::span<SampleBatch> batches, const std::function<bool()>& is_over) {
    // Number of paths that are traced together, to amortise the cost of a call.
    constexpr std::size_t paths_per_tile = 2048;
    std::size_t largest = 1;
    for (const SampleBatch& b : batches) largest = std::max<std::size_t>(largest, 2 * std::size_t{b.half_size});
    const std::size_t per_tile = std::max<std::size_t>(1, paths_per_tile / largest);
    std::vector<RayCounts> counts((batches.size() + per_tile - 1) / per_tile);
    parallel_for_own_ranges(ranks_, batches.size(), per_tile, [&](std::size_t begin, std::size_t end) {
        if (is_over()) return;
        PathIntegrator& integrator = integrators_.local();
        integrator.trace(batches.subspan(begin, end - begin), nearby_ ? &*nearby_ : nullptr);
        counts[begin / per_tile] = integrator.counts();
    });
    collect_ranges(ranks_, batches, per_tile, Destination::first_rank);
    collect_ranges(ranks_, std::span(counts), 1, Destination::first_rank);
    RayCounts sum;
    for (const RayCounts& c : counts) sum += c;
    return sum;
}

}  // namespace interflect::detail
