#include "interflect/solver/ray_maker.h"

#include <span>

#include "interflect/base/random.h"
#include "interflect/solver/ray_source.h"

namespace interflect::inline detail {

namespace {

enum class Purpose : std::uint64_t { allocation = 1, sampling = 2, emission = 3 };

std::uint64_t stream_key(const SampleStreams& streams, Purpose purpose, std::uint64_t index) {
    return mix(mix(streams.seed, static_cast<std::uint64_t>(purpose)), index);
}

}  // namespace

RayMaker::RayMaker(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                   const SampleStreams& streams)
    : forest_(forest),
      elements_(forest.size()),
      emission_(step.emission),
      start_points_(step.start_points),
      streams_(streams),
      ray_caster_(ray_caster),
      allocation_(step.q, step.rays, random_double(stream_key(streams, Purpose::allocation, 0), streams.allocations)) {}

void RayMaker::make(std::int64_t begin, std::int64_t end, RayBatch& batch) const {
    const auto count = static_cast<std::size_t>(end - begin);
    batch.rays.resize(count);
    batch.origins.resize(count);
    batch.sources.clear();
    const auto make_some = [&](std::size_t s, std::int64_t first, std::int64_t from, std::int64_t to) {
        const auto source = static_cast<std::uint32_t>(s);
        const auto offset = static_cast<std::size_t>(from - begin), length = static_cast<std::size_t>(to - from);
        const auto skipped = static_cast<std::uint64_t>(from - first);
        if (source < elements_)
            shoot_from_leaf(source, skipped, offset, length, batch);
        else
            shoot_from_part(source - elements_, skipped, offset, length, batch);
        batch.sources.push_back(
            {source, static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(offset + length)});
    };
    allocation_.for_each_source(begin, end, make_some);
}

void RayMaker::shoot_from_leaf(std::uint32_t leaf, std::uint64_t skipped, std::size_t offset, std::size_t length,
                               RayBatch& batch) const {
    const std::uint32_t patch = forest_.patch(leaf);
    const std::uint64_t place = std::uint64_t{patch} << 32 | forest_.path(leaf);
    const std::uint64_t used = leaf < streams_.used.size() ? streams_.used[leaf] : 0;
    const std::span<const StartPoint> starts = start_points_ ? start_points_->of(leaf) : std::span<const StartPoint>();
    shoot_rays(forest_.geometry(patch), forest_.cell(leaf), ray_caster_.ray_offset(patch), streams_.points,
               stream_key(streams_, Purpose::sampling, place), used + skipped, batch.points,
               std::span(batch.rays).subspan(offset, length), std::span(batch.origins).subspan(offset, length), starts);
}

void RayMaker::shoot_from_part(std::uint32_t part, std::uint64_t skipped, std::size_t offset, std::size_t length,
                               RayBatch& batch) const {
    const std::uint64_t used = part < streams_.used_by_parts.size() ? streams_.used_by_parts[part] : 0;
    emission_->shoot(part, streams_.points, stream_key(streams_, Purpose::emission, part), used + skipped, batch.points,
                     std::span(batch.rays).subspan(offset, length));
}

}  // namespace interflect::inline detail
