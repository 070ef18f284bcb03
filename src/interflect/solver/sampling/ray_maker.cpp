#include "interflect/solver/sampling/ray_maker.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

namespace {

enum class Purpose : std::uint64_t { allocation = 1, sampling = 2, emission = 3 };

std::uint64_t stream_key(const SampleStreams& streams, Purpose purpose, std::uint64_t index) {
    return mix(mix(streams.seed, static_cast<std::uint64_t>(purpose)), index);
}

struct CosSin {
    float cosine, sine;
};

/// Returns the cosine and sine of 2 pi `turn`, for `turn` in [0, 1], with an error of 3e-7. Compilers generate vector
/// code.
inline CosSin cos_sin_of_turn(float turn) {
    // Subtract the nearest quarter turn, then use Taylor series on [-pi/4, pi/4].
    const float quadrant = std::floor(4 * turn + 0.5f);
    const float x = (turn - 0.25f * quadrant) * 6.283185307f, x2 = x * x;
    const float s = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040))));
    const float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    const int q = static_cast<int>(quadrant) & 3;
    const float a = (q & 1) ? s : c, b = (q & 1) ? c : s;
    return {(q == 1 || q == 2) ? -a : a, (q & 2) ? -b : b};
}

}  // namespace

void shoot_rays(const PatchGeometry& patch, const Cell& cell, float offset, PointSet set, std::uint64_t key,
                std::uint64_t first_sample, PointBlock& points, std::span<Ray> rays, std::span<Parameters> origins,
                std::span<const StartPoint> starts) {
    const V3f normal = patch.normal();
    const TangentFrame frame(normal);
    for (std::size_t begin = 0; begin < rays.size(); begin += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, rays.size() - begin);
        fill_points(set, key, first_sample + begin, count, points);
        auto& [a, b, c, d] = points.coordinate;
        // Malley's method: project a uniform point of the disk to the hemisphere
        for (std::size_t i = 0; i < count; ++i) {
            const float radius = std::sqrt(c[i]), height = std::sqrt(1 - c[i]);
            const CosSin turn = cos_sin_of_turn(d[i]);
            rays[begin + i].direction =
                frame.s * (radius * turn.cosine) + frame.t * (radius * turn.sine) + normal * height;
        }
        for (std::size_t i = 0; i < count; ++i) {
            origins[begin + i] = starts.empty() ? patch.uniform_parameters(a[i], b[i], {cell.u, cell.v}, cell.size)
                                                : StartPoints::choose(starts, a[i]);
            rays[begin + i].origin = patch.point(origins[begin + i]) + normal * offset;
        }
    }
}

RayMaker::RayMaker(const ElementForest& forest, const RayCaster& ray_caster, const RayPlan& plan,
                   const SampleStreams& streams)
    : forest_(forest),
      elements_(forest.size()),
      emission_(plan.emission),
      start_points_(plan.start_points),
      streams_(streams),
      ray_caster_(ray_caster),
      allocation_(plan.q, plan.rays, random_double(stream_key(streams, Purpose::allocation, 0), streams.allocations)) {}

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
            shoot_from_leaf(ElementIndex(source), skipped, offset, length, batch);
        else
            shoot_from_part(source - elements_, skipped, offset, length, batch);
        batch.sources.push_back(
            {source, static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(offset + length)});
    };
    allocation_.for_each_source(begin, end, make_some);
}

void RayMaker::shoot_from_leaf(ElementIndex leaf, std::uint64_t skipped, std::size_t offset, std::size_t length,
                               RayBatch& batch) const {
    const PatchIndex patch = forest_.patch(leaf);
    const std::uint64_t leaf_key = std::uint64_t{patch} << 32 | forest_.path(leaf);
    const std::uint64_t used = leaf < streams_.used.size() ? streams_.used[leaf] : 0;
    const std::span<const StartPoint> starts = start_points_ ? start_points_->of(leaf) : std::span<const StartPoint>();
    shoot_rays(forest_.geometry(patch), forest_.cell(leaf), ray_caster_.ray_offset(patch), streams_.points,
               stream_key(streams_, Purpose::sampling, leaf_key), used + skipped, batch.points,
               std::span(batch.rays).subspan(offset, length), std::span(batch.origins).subspan(offset, length), starts);
}

void RayMaker::shoot_from_part(std::uint32_t part, std::uint64_t skipped, std::size_t offset, std::size_t length,
                               RayBatch& batch) const {
    const std::uint64_t used = part < streams_.used_by_parts.size() ? streams_.used_by_parts[part] : 0;
    emission_->shoot(part, streams_.points, stream_key(streams_, Purpose::emission, part), used + skipped, batch.points,
                     std::span(batch.rays).subspan(offset, length));
}

void advance(SampleStreams& streams, const RayAllocation& allocation, std::size_t elements, std::size_t parts) {
    constexpr std::size_t blocks_per_task = Counts::block / RayAllocation::block_sources;
    streams.used.resize(std::max(streams.used.size(), elements));
    streams.used_by_parts.resize(std::max(streams.used_by_parts.size(), parts), 0);
    // A source belongs to a single block and hence to a single thread.
    parallel_for_ranges(allocation.block_count(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                const auto used = static_cast<std::uint64_t>(next - first);
                if (s < elements)
                    streams.used.add(s, used);
                else
                    streams.used_by_parts[s - elements] += used;
                return true;
            });
    });
    ++streams.allocations;
}

}  // namespace interflect::detail
