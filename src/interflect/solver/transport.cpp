#include "interflect/solver/transport.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "interflect/base/fixed_point.h"
#include "interflect/base/parallel.h"
#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/gathering.h"
#include "interflect/solver/ray_allocation.h"
#include "interflect/solver/ray_source.h"
#include "interflect/solver/receiving.h"

namespace interflect {

namespace {

/// Rays of one task: enough to hide the cost of a task, few enough to stay in the second-level cache.
constexpr std::size_t batch_rays = 1024;
/// How far ahead of the rays under way the patches that others hit are asked for.
constexpr std::size_t rays_ahead = 32;

/// Keys of the random numbers, so that no two purposes share one.
enum class Purpose : std::uint64_t { allocation = 1, sampling = 2, emission = 3 };

std::uint64_t stream_key(const SampleStreams& streams, Purpose purpose, std::uint64_t index) {
    return mix(mix(streams.seed, static_cast<std::uint64_t>(purpose)), index);
}

/// The rays of one task that start on the same leaf or part of a luminaire: batch.rays[begin ... end - 1].
struct SourceRays {
    std::uint32_t source;  // the leaf, or elements of the forest + the part
    std::uint32_t begin, end;
};

/// The rays of one task; one a thread, reused.
struct RayBatch {
    std::vector<SourceRays> sources;
    std::vector<Ray> rays;
    std::vector<Parameters> origins;
    PointBlock points;
};

/// Makes the rays of a step.
class RayMaker {
  public:
    RayMaker(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
             const SampleStreams& streams)
        : forest_(forest),
          elements_(forest.size()),
          emission_(step.emission),
          streams_(streams),
          ray_caster_(ray_caster),
          allocation_(step.q, step.rays,
                      random_double(stream_key(streams, Purpose::allocation, 0), streams.allocations)) {}

    const RayAllocation& allocation() const { return allocation_; }

    /// Makes the rays begin ... end - 1.
    void make(std::int64_t begin, std::int64_t end, RayBatch& batch) const {
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

  private:
    void shoot_from_leaf(std::uint32_t leaf, std::uint64_t skipped, std::size_t offset, std::size_t length,
                         RayBatch& batch) const {
        const std::uint32_t patch = forest_.patch(leaf);
        const std::uint64_t place = std::uint64_t{patch} << 32 | forest_.path(leaf);
        const std::uint64_t used = leaf < streams_.used.size() ? streams_.used[leaf] : 0;
        shoot_rays(forest_.geometry(patch), forest_.cell(leaf), ray_caster_.ray_offset(patch), streams_.points,
                   stream_key(streams_, Purpose::sampling, place), used + skipped, batch.points,
                   std::span(batch.rays).subspan(offset, length), std::span(batch.origins).subspan(offset, length));
    }

    void shoot_from_part(std::uint32_t part, std::uint64_t skipped, std::size_t offset, std::size_t length,
                         RayBatch& batch) const {
        const std::uint64_t used = part < streams_.used_by_parts.size() ? streams_.used_by_parts[part] : 0;
        emission_->shoot(part, streams_.points, stream_key(streams_, Purpose::emission, part), used + skipped,
                         batch.points, std::span(batch.rays).subspan(offset, length));
    }

    const ElementForest& forest_;
    const std::uint32_t elements_;  // when the step began
    const Emission* emission_;
    const SampleStreams& streams_;
    const RayCaster& ray_caster_;
    RayAllocation allocation_;
};

/// What one ray of each source carries: A_s / (N q_s) of a leaf's radiosity and of its reflected importance, 1 / (N
/// q_s) of what a part of a luminaire emits.
class Carried {
  public:
    Carried(const Materials& materials, const ElementForest& forest, const TransportStep& step, double q_sum)
        : materials_(materials),
          forest_(forest),
          step_(step),
          elements_(forest.size()),
          q_sum_over_rays_(q_sum / static_cast<double>(step.rays)) {}

    RgbD power(std::uint32_t source) const { return per_ray(source, radiated(source)); }
    /// Of that, what a light group brings.
    RgbD power(std::uint32_t source, std::size_t group) const {
        if (source < elements_) {
            const Rgb share = step_.groups.of(materials_, forest_, source, group);
            return is_finite(share) ? per_ray(source, RgbD(share)) : RgbD(0);
        }
        return step_.groups.has_part(*step_.emission, source - elements_, group) ? power(source) : RgbD(0);
    }
    double importance(std::uint32_t source) const { return source < elements_ ? importance_of_leaf(source) : 0; }

  private:
    RgbD radiated(std::uint32_t source) const {
        return source < elements_ ? RgbD(step_.light.of(forest_, source)) : step_.emission->power(source - elements_);
    }
    /// What each ray has of something that a source radiates.
    RgbD per_ray(std::uint32_t source, const RgbD& light) const {
        if (!step_.equal_quanta) return light * (source < elements_ ? area_per_ray(source) : per_ray(source));
        const double sum = channel_sum(radiated(source));
        return sum > 0 ? light / sum : RgbD(0);
    }
    double importance_of_leaf(std::uint32_t leaf) const {
        return materials_.mean_reflectance(forest_.patch(leaf), leaf) * step_.importance[leaf] * area_per_ray(leaf);
    }
    double per_ray(std::uint32_t source) const { return q_sum_over_rays_ / step_.q[source]; }
    double area_per_ray(std::uint32_t leaf) const { return forest_.area(leaf) * per_ray(leaf); }

    const Materials& materials_;
    const ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t elements_;  // when the step began
    double q_sum_over_rays_;
};

/// What all rays of a step carry together.
struct Totals {
    RgbD power{0, 0, 0};  ///< [lm or W]
    double square = 0;    ///< Of the luminance of each ray's power, summed.
    double importance = 0;
    double importance_square = 0;  ///< Of each ray's importance, summed.
    Quanta quanta;

    Totals& operator+=(const Totals& other) {
        power += other.power;
        square += other.square;
        importance += other.importance;
        importance_square += other.importance_square;
        quanta += other.quanta;
        return *this;
    }
};

Totals all_carried(const TransportStep& step, const RayAllocation& allocation, const Carried& carried) {
    constexpr std::size_t blocks_at_once = 16;
    return parallel_sum(allocation.block_count(), blocks_at_once, Totals(), [&](std::size_t begin, std::size_t end) {
        Totals sum;
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                const auto source = static_cast<std::uint32_t>(s);
                const auto count = static_cast<double>(next - first);
                if (step.carries_power()) {
                    const RgbD power = carried.power(source);
                    sum.power += power * count;
                    sum.square += std::pow(luminance(power), 2) * count;
                    sum.quanta.add(channel_sum(power), next - first);
                }
                if (step.carries_importance()) {
                    const double importance = carried.importance(source);
                    sum.importance += importance * count;
                    sum.importance_square += importance * importance * count;
                }
                return true;
            });
        return sum;
    });
}

/// The units in which arrivals are counted: what all rays carry fits.
struct Units {
    FixedPoint power, square, importance;

    explicit Units(const Totals& all) : power(channel_sum(all.power)), square(all.square), importance(all.importance) {}

    Arrivals::Contribution contribution(const TransportStep& step, const Carried& carried, std::uint32_t source) const {
        Arrivals::Contribution contribution{};
        if (step.carries_power()) {
            const RgbD carried_power = carried.power(source);
            const FixedPoint::Value of_power = power.from(carried_power);
            std::copy(of_power.begin(), of_power.end(), contribution.begin());
            contribution[3] = square.from(std::pow(luminance(carried_power), 2));
        }
        if (step.carries_importance())
            contribution[Arrivals::importance_term] = importance.from(carried.importance(source));
        return contribution;
    }

    /// Of that the power of each light group.
    void add_groups(const TransportStep& step, const Carried& carried, std::uint32_t source,
                    std::vector<std::int64_t>& terms) const {
        terms.clear();
        for (std::size_t g = 0; g < step.groups.size(); ++g) {
            const FixedPoint::Value of_group = power.from(carried.power(source, g));
            terms.insert(terms.end(), of_group.begin(), of_group.end());
        }
    }
};

/// Notes how many points every leaf, and every part of the luminaires, has consumed.
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

/// What becomes of one task's rays; one a thread, reused.
struct Batch {
    explicit Batch(const Receiver& r) : receiver(r) {}

    RayBatch shot;
    std::vector<Hit> hits;
    std::vector<std::int64_t> group_terms;  // of one source
    Receiver receiver;
};

/// What arrived at elements of which those from `old_size` on have got other numbers since.
class Arrived {
  public:
    Arrived(Arrivals& arrivals, std::uint32_t old_size, std::vector<std::uint32_t> old_numbers)
        : arrivals_(arrivals), old_size_(old_size), old_numbers_(std::move(old_numbers)) {}

    Arrivals::Contribution take(std::uint32_t e) { return arrivals_.take(number(e)); }
    std::array<std::int64_t, 3> take(std::uint32_t e, std::size_t group) { return arrivals_.take(number(e), group); }
    /// What arrived at an element arrives at another one.
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

/// Keeps the forest within the oracle's limit; what arrived at elements that are dropped arrives at their parents.
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

/// Nothing where a step carries no importance, or none that leaves are told apart by, and no luminaire shoots.
std::optional<GatheredImportance> gathered_by(const TransportStep& step, const Materials& materials,
                                              const ElementForest& forest) {
    if (!step.carries_importance() || (step.importance_at_patches && step.part_count() == 0)) return {};
    std::vector<double> largest((forest.size() + elements_at_once - 1) / elements_at_once, 0.0);
    parallel_for_ranges(forest.size(), elements_at_once, [&](std::size_t begin, std::size_t end) {
        double& most = largest[begin / elements_at_once];
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e)
            most = std::max<double>(most, materials.mean_reflectance(forest.patch(e), e) * step.importance[e]);
    });
    return std::optional<GatheredImportance>(std::in_place, *std::max_element(largest.begin(), largest.end()),
                                             step.rays, forest.size() + step.part_count());
}

/// What the rays of parts of the luminaires found.
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

/// Replaces the importance that a leaf received by its mean with what the leaf's own rays found. Each of these counts
/// as one ray, and as many are expected to have brought it as if all that do carried alike: weights that do not depend
/// on what is found leave the mean where it is.
void blend(const ElementForest& forest, const TransportStep& step, const RayAllocation& allocation,
           const GatheredImportance& gathered, const Totals& carried, std::size_t elements,
           std::vector<float>& received) {
    // Where none is carried, none is known from what arrives.
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

/// Turns sums of arrivals into what each element receives, per unit of area.
void collect(const ElementForest& forest, const TransportStep& step, const Units& units, Arrived& arrived,
             Received& received) {
    constexpr std::size_t at_once = std::size_t{1} << 16;  // their sums fill a large page of 2 MiB
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

/// Adds what ancestors received, and lets inner elements have the mean of their children.
void balance(const ElementForest& forest, const TransportStep& step, Received& received) {
    if (step.carries_power() && !step.leaves_only) {
        push(forest, received.irradiance), pull(forest, received.irradiance);
        push(forest, received.variance), pull_variance(forest, received.variance);
        for (std::vector<Rgb>& of_group : received.groups) push(forest, of_group), pull(forest, of_group);
    }
    if (step.carries_importance()) push(forest, received.importance), pull(forest, received.importance);
}

}  // namespace

Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop) {
    assert(step.q.size() == forest.size() + step.part_count() && step.rays > 0);
    Received received;
    const RayMaker maker(forest, ray_caster, step, streams);
    const RayAllocation& allocation = maker.allocation();
    if (!(allocation.q_sum() > 0)) {
        received.irradiance.assign(step.carries_power() ? forest.size() : 0, Rgb(0));
        received.variance.assign(received.irradiance.size(), 0.0f);
        received.importance.assign(step.carries_importance() ? forest.size() : 0, 0.0f);
        received.groups.assign(step.groups.size(), std::vector<Rgb>(forest.size(), Rgb(0)));
        return received;
    }

    const Carried carried(materials, forest, step, allocation.q_sum());
    const Totals all = all_carried(step, allocation, carried);
    const Units units(all);
    arrivals.begin(forest.size());
    const std::uint32_t old_size = forest.size();
    std::optional<GatheredImportance> gathered = gathered_by(step, materials, forest);
    PerThread<Batch> batches([&] {
        return Batch({materials, forest, step, old_size, arrivals, gathered ? &*gathered : nullptr});
    });
    const auto trace_batch = [&](std::size_t begin, std::size_t end) {
        auto& [shot, hits, group_terms, receiver] = batches.local();
        maker.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), shot);
        hits.resize(shot.rays.size());
        ray_caster.trace(shot.rays, hits);
        std::size_t fetched = 0;
        for (const auto& [source, first, last] : shot.sources) {
            const std::size_t fetch = std::min<std::size_t>(last + rays_ahead, hits.size());
            for (; fetched < fetch; ++fetched) receiver.prefetch(hits[fetched]);
            units.add_groups(step, carried, source, group_terms);
            receiver.take(source, units.contribution(step, carried, source), group_terms,
                          std::span(shot.rays).subspan(first, last - first),
                          std::span(shot.origins).subspan(first, last - first),
                          std::span(hits).subspan(first, last - first));
        }
        receiver.finish_batch();
    };
    try {
        parallel_for_ranges(static_cast<std::size_t>(step.rays), batch_rays, stop, trace_batch);
    } catch (const Interrupted&) {
        arrivals.clear(forest.size());
        forget_new_elements(forest, old_size);
        throw;
    }
    FixedPoint::Value escaped{};
    for (Batch& batch : batches) {
        const Escaped e = batch.receiver.finish();
        for (std::size_t c = 0; c < 3; ++c) escaped[c] += e.power[c];
        received.escaped_rays += e.rays;
    }

    advance(streams, allocation, old_size, step.part_count());
    Arrived arrived(arrivals, old_size, forest.put_in_order(old_size));
    drop_excess(forest, arrived, step.oracle.max_elements, old_size);
    step.oracle.importance = std::vector<float>();  // what has served makes room for what is received
    if (!gathered) step.q = std::vector<float>();
    if (step.spent) received.irradiance = std::move(*step.spent);
    collect(forest, step, units, arrived, received);
    if (gathered && !step.importance_at_patches)
        blend(forest, step, allocation, *gathered, all, old_size, received.importance);
    if (gathered) received.part_importance = found_by_parts(step, allocation, *gathered, old_size);
    balance(forest, step, received);
    received.shot_power = all.power;
    received.quanta = all.quanta;
    received.escaped_power = units.power.to_colour(escaped);
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

}  // namespace interflect
