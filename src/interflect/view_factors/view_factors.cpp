#include "interflect/view_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/view_factors/rays/group_rays.h"
#include "interflect/view_factors/rays/hit_counts.h"

namespace interflect {

using namespace detail;

namespace {

/// Independent scramblings of each group's points. Their spread estimates errors with 31 degrees of freedom; more would
/// reduce the stratification of each.
constexpr std::size_t replicates = 32;
constexpr std::int64_t min_rays_per_group = 1024, max_rays_per_group = std::int64_t{1} << 36;
constexpr std::size_t max_groups = (std::size_t{1} << 31) - 4;  // leaves room for three more columns
/// Number of rays between two reports, and minimum number of one task.
constexpr std::int64_t rays_per_wave = 1 << 22, rays_per_task = 1 << 14;

std::int64_t rays_per_group(const ViewFactorOptions& options, std::size_t groups) {
    if (options.rays <= 0) throw InputError(fmt::format("rays: expected a positive number, found {}", options.rays));
    if (groups == 0) throw InputError("expected at least one group of faces");
    if (groups > max_groups)
        throw InputError(fmt::format("{} groups of faces; at most {} are possible", groups, max_groups));
    const auto per_group = static_cast<std::uint64_t>(options.rays) / groups;
    return std::clamp(static_cast<std::int64_t>(std::bit_floor(per_group)), min_rays_per_group, max_rays_per_group);
}

/// Columns of a row after the columns of the groups.
struct OtherColumns {
    explicit OtherColumns(std::size_t groups)
        : sky(static_cast<std::uint32_t>(groups)), ground(sky + 1), blocked(sky + 2), count(groups + 3) {}
    std::uint32_t sky, ground, blocked;
    std::size_t count;
};

std::vector<std::uint32_t> columns_of_patches(const Scene& scene, std::span<const FaceGroup> groups,
                                              std::uint32_t blocked) {
    std::vector<std::uint32_t> column(scene.patches.size(), blocked);
    for (std::uint32_t g = 0; g < groups.size(); ++g)
        for (const std::uint32_t p : groups[g].patches) {
            if (p >= scene.patches.size())
                throw InputError(fmt::format("group '{}' has patch {}; the scene has {} patches", groups[g].name, p,
                                             scene.patches.size()));
            if (column[p] != blocked)
                throw InputError(fmt::format("patch {} belongs to the groups '{}' and '{}'; expected one group", p,
                                             groups[column[p]].name, groups[g].name));
            column[p] = g;
        }
    return column;
}

/// Appends rows. Grows by a quarter, because doubling would need three times the final memory.
class RowAppender {
  public:
    RowAppender(ViewFactors& factors, const OtherColumns& others) : factors_(factors), others_(others) {}

    void append(std::span<const EstimatedFactor> row) {
        reserve_for(row.size());
        const std::size_t group = factors_.row_offsets.size() - 1;
        for (const EstimatedFactor& entry : row) {
            if (entry.column == others_.sky) {
                factors_.sky[group] = entry.value;
                factors_.sky_errors[group] = entry.error;
            } else if (entry.column == others_.ground) {
                factors_.ground[group] = entry.value;
                factors_.ground_errors[group] = entry.error;
            } else if (entry.column == others_.blocked) {
                factors_.blocked[group] = entry.value;
                factors_.blocked_errors[group] = entry.error;
            } else {
                factors_.columns.push_back(static_cast<std::int32_t>(entry.column));
                factors_.values.push_back(entry.value);
                factors_.errors.push_back(entry.error);
            }
        }
        factors_.row_offsets.push_back(static_cast<std::int64_t>(factors_.columns.size()));
    }

  private:
    void reserve_for(std::size_t count) {
        const std::size_t needed = factors_.columns.size() + count;
        if (needed <= factors_.columns.capacity()) return;
        const std::size_t capacity = std::max(needed, factors_.columns.capacity() / 4 * 5);
        factors_.columns.reserve(capacity);
        factors_.values.reserve(capacity);
        factors_.errors.reserve(capacity);
    }

    ViewFactors& factors_;
    const OtherColumns& others_;
};

struct ThreadBuffers {
    explicit ThreadBuffers(std::size_t columns) : counter(columns) {}

    GroupRays::Batch batch;
    HitCounter counter;
};

/// Traces the rays of the groups in waves and estimates their factors.
class Estimator {
  public:
    Estimator(const Scene& scene, const RayCaster& ray_caster, std::span<const FaceGroup> groups,
              const ViewFactorOptions& options)
        : ray_caster_(ray_caster),
          seed_(options.seed),
          rays_of_replicate_(static_cast<std::uint64_t>(rays_per_group(options, groups.size())) / replicates),
          others_(groups.size()),
          column_of_patch_(columns_of_patches(scene, groups, others_.blocked)),
          buffers_([columns = others_.count] { return ThreadBuffers(columns); }) {
        for (const FaceGroup& group : groups) {
            sources_.emplace_back(scene, ray_caster, group);
            factors_.names.push_back(group.name);
            factors_.areas.push_back(sources_.back().area());
        }
        for (std::vector<float>* values : {&factors_.sky, &factors_.ground, &factors_.blocked})
            values->assign(groups.size(), 0);
        factors_.rays_per_group = static_cast<std::int64_t>(rays_of_replicate_ * replicates);
        const auto smallest_error = static_cast<float>(factors_.smallest_error());
        for (std::vector<float>* errors : {&factors_.sky_errors, &factors_.ground_errors, &factors_.blocked_errors})
            errors->assign(groups.size(), smallest_error);
        factors_.row_offsets.assign(1, 0);
    }

    ViewFactors estimate(const Monitor& monitor) {
        const StopRequest stop(monitor.stop);
        const std::size_t groups = sources_.size();
        const auto wave_groups =
            static_cast<std::size_t>(std::clamp<std::int64_t>(rays_per_wave / factors_.rays_per_group, 1, 1 << 16));
        RowAppender rows(factors_, others_);
        for (std::size_t first = 0; first < groups; first += wave_groups) {
            const std::size_t count = std::min(wave_groups, groups - first);
            try {
                for (const auto& row : estimate_rows(first, count, stop)) rows.append(row);
            } catch (const Interrupted&) {
                throw Stopped(fmt::format("the view factors of {} of {} groups are missing", groups - first, groups));
            }
            if (monitor.on_progress)
                monitor.on_progress({static_cast<std::int64_t>(first + count) * factors_.rays_per_group,
                                     static_cast<double>(first + count) / static_cast<double>(groups)});
        }
        return std::move(factors_);
    }

  private:
    std::vector<std::vector<EstimatedFactor>> estimate_rows(std::size_t first, std::size_t count,
                                                            const StopRequest& stop) {
        std::vector<ReplicateHits> hits(count * replicates);
        const std::size_t replicate_grain = std::max<std::size_t>(1, rays_per_task / rays_of_replicate_);
        parallel_for_ranges(hits.size(), replicate_grain, stop, [&](std::size_t begin, std::size_t end) {
            ThreadBuffers& buffers = buffers_.local();
            for (std::size_t i = begin; i < end; ++i)
                trace(first + i / replicates, i % replicates, stop, buffers, hits[i]);
        });
        if (stop.is_due()) throw Interrupted();
        std::vector<std::vector<EstimatedFactor>> rows(count);
        const std::size_t row_grain =
            std::max<std::size_t>(1, rays_per_task / static_cast<std::size_t>(factors_.rays_per_group));
        parallel_for_ranges(count, row_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row)
                rows[row] = estimate_row(std::span(hits).subspan(row * replicates, replicates));
        });
        return rows;
    }

    void trace(std::size_t group, std::size_t replicate, const StopRequest& stop, ThreadBuffers& buffers,
               ReplicateHits& result) const {
        const GroupRays& source = sources_[group];
        if (!(source.area() > 0)) return;
        const std::uint64_t key = mix(mix(seed_, group), replicate);
        auto& [batch, counter] = buffers;
        for (std::uint64_t first = 0; first < rays_of_replicate_ && !stop.is_due(); first += PointBlock::capacity) {
            const auto count =
                static_cast<std::size_t>(std::min<std::uint64_t>(PointBlock::capacity, rays_of_replicate_ - first));
            source.make(key, first, count, batch);
            batch.hits.resize(batch.rays.size());
            ray_caster_.trace(batch.rays, batch.hits);
            for (std::size_t i = 0; i < batch.rays.size(); ++i) {
                const std::uint32_t escaped = batch.rays[i].direction.z > 0 ? others_.sky : others_.ground;
                const PatchIndex patch = batch.hits[i].patch;
                counter.add(patch == none ? escaped : column_of_patch_[patch]);
            }
            result.rays += static_cast<std::int64_t>(batch.rays.size());
        }
        counter.finish(result);
    }

    const RayCaster& ray_caster_;
    const std::uint64_t seed_, rays_of_replicate_;
    const OtherColumns others_;
    const std::vector<std::uint32_t> column_of_patch_;
    std::vector<GroupRays> sources_;
    ViewFactors factors_;
    PerThread<ThreadBuffers> buffers_;
};

}  // namespace

ViewFactors::Factor ViewFactors::factor(std::size_t i, std::size_t j) const {
    const auto begin = columns.begin() + row_offsets[i], end = columns.begin() + row_offsets[i + 1];
    const auto found = std::lower_bound(begin, end, static_cast<std::int32_t>(j));
    if (found == end || *found != static_cast<std::int32_t>(j)) return {0, smallest_error()};
    const auto entry = static_cast<std::size_t>(found - columns.begin());
    return {values[entry], errors[entry]};
}

double ViewFactors::closure(std::size_t i) const {
    const double others = double{sky[i]} + double{ground[i]} + double{blocked[i]};
    return std::accumulate(values.begin() + row_offsets[i], values.begin() + row_offsets[i + 1], others);
}

ViewFactors view_factors(const Scene& scene, const RayCaster& ray_caster, std::span<const FaceGroup> groups,
                         const ViewFactorOptions& options, const Monitor& monitor) {
    ray_caster.require_made_for(scene);
    return Estimator(scene, ray_caster, groups, options).estimate(monitor);
}

ViewFactors view_factors(const Scene& scene, std::span<const FaceGroup> groups, const ViewFactorOptions& options,
                         const Monitor& monitor) {
    const Scene opaque = with_opaque_backs(scene);
    return view_factors(opaque, RayCaster(opaque), groups, options, monitor);
}

}  // namespace interflect
