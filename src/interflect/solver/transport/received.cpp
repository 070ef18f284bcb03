#include "interflect/solver/transport/received.h"

#include <utility>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Sums of contributions, indexed by the final index of an element after sorting.
class RenumberedSums {
  public:
    RenumberedSums(ContributionSums& sums, std::uint32_t old_size, std::vector<ElementIndex> old_numbers)
        : sums_(sums), old_size_(old_size), old_numbers_(std::move(old_numbers)) {}

    bool is_zero(ElementIndex e) const { return sums_.is_zero(number(e)); }
    Contribution take(ElementIndex e) { return sums_.take(number(e)); }
    std::array<std::int64_t, 3> take(ElementIndex e, std::size_t group) { return sums_.take(number(e), group); }
    std::size_t terms() const { return sums_.terms(); }
    void read(std::size_t e, std::span<std::int64_t> terms) const { sums_.read(number(e), terms); }
    void take(std::size_t e, std::span<std::int64_t> terms) {
        sums_.read(number(e), terms);
        sums_.clear_one(number(e));
    }
    void add(std::size_t e, std::span<const std::int64_t> terms) { sums_.add(number(e), terms); }
    void move(ElementIndex from, ElementIndex to) {
        sums_.add(number(to), take(from));
        for (std::size_t g = 0; g < sums_.groups(); ++g) sums_.add(number(to), g, take(from, g));
    }
    void release(std::size_t begin, std::size_t end) {
        if (end <= old_size_) sums_.release(begin, end);
    }

  private:
    std::size_t number(std::size_t e) const { return e < old_size_ ? e : old_numbers_[e - old_size_]; }

    ContributionSums& sums_;
    std::uint32_t old_size_;
    std::vector<ElementIndex> old_numbers_;
};

/// Removes the last elements beyond `max_elements`, and adds their sums to their parents.
void drop_excess(ElementForest& forest, RenumberedSums& sums, std::size_t max_elements, std::uint32_t old_size) {
    while (forest.size() > std::max<std::size_t>(max_elements, old_size)) {
        const ElementIndex first(forest.size() - 4), parent = forest.drop_last_siblings();
        for (ElementIndex e = first; e < first + 4; ++e) sums.move(e, parent);
    }
}

std::vector<PartImportance> found_by_parts(const RayPlan& plan, const RayAllocation& allocation,
                                           const FoundImportance& importance, std::size_t elements) {
    std::vector<PartImportance> parts(plan.part_count());
    for (std::size_t block = RayAllocation::block_of(elements); block < allocation.block_count(); ++block)
        allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
            if (s >= elements) parts[s - elements] = {importance.sum(s), static_cast<double>(next - first)};
            return true;
        });
    return parts;
}

/// Averages two estimates of importance: received importance, and importance found at the hits of an element's own
/// rays. The weights are effective numbers of rays. They do not depend on the estimates, so the average is unbiased.
void blend(const ElementForest& forest, const TransportStep& step, const RayAllocation& allocation,
           const FoundImportance& found, const PayloadTotals& payload, std::size_t elements,
           std::vector<float>& received) {
    const double rays_per_importance = payload.importance > 0 ? payload.importance / payload.importance_square : 0;
    constexpr std::size_t blocks_per_task = 16;
    parallel_for_ranges(allocation.block_count(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                if (s >= elements) return false;
                const ElementIndex leaf(s);
                const auto left = static_cast<double>(next - first);
                const double arrived = step.importance[leaf] * forest.area(leaf) * rays_per_importance;
                received[leaf] = static_cast<float>((arrived * received[leaf] + found.sum(leaf)) / (arrived + left));
                return true;
            });
    });
}

void convert(const ElementForest& forest, const TransportStep& step, const ContributionUnits& units,
             RenumberedSums& sums, Received& received) {
    constexpr std::size_t at_once = std::size_t{1} << 16;  // elements whose sums fill more than a page of 2 MiB
    if (step.carries_power()) received.irradiance.resize(forest.size()), received.variance.resize(forest.size());
    if (step.carries_importance()) received.importance.resize(forest.size());
    received.groups.assign(step.groups.size(), std::vector<Rgb>(forest.size()));
    parallel_for_ranges(forest.size(), at_once, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) {
            if (received.groups.empty() && sums.is_zero(e)) {  // avoids writing the sums
                if (step.carries_power()) {
                    received.irradiance[e] = Rgb(0);
                    received.variance[e] = 0;
                }
                continue;
            }
            const auto [red, green, blue, square, importance] = sums.take(e);
            const float area = forest.area(e);
            if (step.carries_power()) {
                received.irradiance[e] = Rgb(units.power.to_colour({red, green, blue})) / area;
                received.variance[e] = static_cast<float>(units.square.to_number(square) / area / area);
            }
            for (std::size_t g = 0; g < received.groups.size(); ++g)
                received.groups[g][e] = Rgb(units.power.to_colour(sums.take(e, g))) / area;
            if (step.carries_importance())
                received.importance[e] = static_cast<float>(units.importance.to_number(importance) / area);
        }
        sums.release(begin, end);
    });
}

void push_pull(const ElementForest& forest, const TransportStep& step, Received& received) {
    if (step.carries_power() && !step.leaves_only) {
        push(forest, received.irradiance);
        pull(forest, received.irradiance);
        push(forest, received.variance);
        pull_variance(forest, received.variance);
        for (std::vector<Rgb>& of_group : received.groups) {
            push(forest, of_group);
            pull(forest, of_group);
        }
    }
    if (step.carries_importance()) {
        push(forest, received.importance);
        pull(forest, received.importance);
    }
}

}  // namespace

Received nothing_received(const TransportStep& step, std::size_t elements) {
    Received received;
    received.irradiance.assign(step.carries_power() ? elements : 0, Rgb(0));
    received.variance.assign(received.irradiance.size(), 0.0f);
    received.importance.assign(step.carries_importance() ? elements : 0, 0.0f);
    received.groups.assign(step.groups.size(), std::vector<Rgb>(elements, Rgb(0)));
    return received;
}

Received collect(TransportStep& step, ElementForest& forest, std::uint32_t old_size, const RayAllocation& allocation,
                 const PayloadTotals& payload, const ContributionUnits& units, const FoundImportance* importance,
                 ContributionSums& sums, Ranks* ranks) {
    RenumberedSums renumbered(sums, old_size, forest.put_in_order(old_size));
    if (ranks) add_over_ranks(*ranks, forest.size(), renumbered);
    drop_excess(forest, renumbered, step.oracle.max_elements, old_size);
    Received received;
    step.oracle.importance = std::vector<float>();
    if (!importance) step.q = std::vector<float>();
    if (step.reusable_buffer) received.irradiance = std::move(*step.reusable_buffer);
    convert(forest, step, units, renumbered, received);
    if (importance && !step.importance_at_patches)
        blend(forest, step, allocation, *importance, payload, old_size, received.importance);
    if (importance) received.part_importance = found_by_parts(step, allocation, *importance, old_size);
    push_pull(forest, step, received);
    received.shot_power = payload.power;
    received.payloads = payload.histogram;
    return received;
}

}  // namespace interflect::detail
