#include "interflect/solver/transport/received.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/thread_count.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Sums of contributions, indexed by the final index of an element after sorting.
class RenumberedSums {
  public:
    RenumberedSums(ContributionSums& sums, std::uint32_t old_size, std::vector<ElementIndex> old_numbers)
        : sums_(sums), old_size_(old_size), old_numbers_(std::move(old_numbers)) {}

    bool are_simple() const { return sums_.are_simple(); }
    template <bool are_simple>
    bool is_zero(ElementIndex e) const {
        return are_simple ? sums_.is_simple_zero(number(e)) : sums_.is_zero(number(e));
    }
    Contribution take(ElementIndex e) { return sums_.take(number(e)); }
    std::array<std::int64_t, 3> take(ElementIndex e, std::size_t group) { return sums_.take(number(e), group); }
    std::size_t terms() const { return sums_.terms(); }
    bool is_zero(std::size_t e) const { return sums_.groups() == 0 && sums_.is_zero(number(e)); }
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

/// Received values as integers, for share_parts().
class ReceivedBits {
  public:
    explicit ReceivedBits(Received& received) : received_(received) {}

    std::size_t terms() const {
        return (received_.irradiance.empty() ? 0 : 4) + (received_.importance.empty() ? 0 : 1) +
               3 * received_.groups.size();
    }
    bool is_zero(std::size_t e) const {
        const bool has_power =
            !received_.irradiance.empty() && (received_.irradiance[e] != Rgb(0) || received_.variance[e] != 0);
        const bool has_importance = !received_.importance.empty() && received_.importance[e] != 0;
        return !has_power && !has_importance && received_.groups.empty();
    }
    void read(std::size_t e, std::span<std::int64_t> row) const {
        std::size_t t = 0;
        for_each_number(received_, e, [&](float number) { row[t++] = std::bit_cast<std::uint32_t>(number); });
    }
    void add(std::size_t e, std::span<const std::int64_t> row) {
        std::size_t t = 0;
        for_each_number(received_, e,
                        [&](float& number) { number = std::bit_cast<float>(static_cast<std::uint32_t>(row[t++])); });
    }

  private:
    template <class Visit>
    static void for_each_number(Received& received, std::size_t e, const Visit& visit) {
        const auto visit_colour = [&](Rgb& colour) {
            for (int c = 0; c < 3; ++c) visit(colour[c]);
        };
        if (!received.irradiance.empty()) {
            visit_colour(received.irradiance[e]);
            visit(received.variance[e]);
        }
        if (!received.importance.empty()) visit(received.importance[e]);
        for (std::vector<Rgb>& of_group : received.groups) visit_colour(of_group[e]);
    }
    Received& received_;
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

/// Converts the sums of the range `own`. The other elements have 0.
template <bool are_simple>
void convert(const ElementForest& forest, const TransportStep& step, const ContributionUnits& units,
             RenumberedSums& sums, const ElementRange& own, Received& received) {
    constexpr std::size_t at_once = std::size_t{1} << 16;  // elements whose sums fill about a page of 2 MiB
    received.groups.assign(step.groups.size(), std::vector<Rgb>(forest.size()));
    const auto skip = [&](std::size_t begin, std::size_t end) {
        if (step.carries_power())
            for (std::size_t e = begin; e < end; ++e) {
                received.irradiance[e] = Rgb(0);
                received.variance[e] = 0;
            }
        for (std::vector<Rgb>& of_group : received.groups)
            for (std::size_t e = begin; e < end; ++e) of_group[e] = Rgb(0);
        if (begin < end) sums.release(begin, end);
    };
    const auto convert_some = [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) {
            if (received.groups.empty() && sums.is_zero<are_simple>(e)) {  // avoids writing the sums
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
        if (begin < end) sums.release(begin, end);
    };
    const std::size_t size = forest.size();
    const auto for_each_array = [&](const auto& body) {
        if (step.carries_power()) {
            body(received.irradiance);
            body(received.variance);
        }
        if (step.carries_importance()) body(received.importance);
    };
    for_each_array([&](auto& values) { values.reserve(size); });
    // The values use memory only as fast as sums release theirs
    const std::size_t between_releases = std::max(many_elements, at_once * static_cast<std::size_t>(thread_count()));
    for (std::size_t first = 0; first < size; first += between_releases) {
        const std::size_t last = std::min(size, first + between_releases);
        for_each_array([&](auto& values) { values.resize(std::max(values.size(), last)); });
        parallel_for_ranges(last - first, at_once, [&](std::size_t from, std::size_t to) {
            const std::size_t begin = first + from, end = first + to;
            const std::size_t own_begin = std::clamp(own.begin, begin, end), own_end = std::clamp(own.end, begin, end);
            skip(begin, own_begin);
            convert_some(own_begin, own_end);
            skip(own_end, end);
        });
    }
    for_each_array([&](auto& values) { values.resize(size); });
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
    // Ranks convert the sums of their own elements, unless elements beyond the limit must be merged before
    const bool shares_conversion = ranks && forest.size() <= std::max<std::size_t>(step.oracle.max_elements, old_size);
    if (shares_conversion)
        add_in_parts(*ranks, forest.size(), renumbered);
    else if (ranks)
        add_over_ranks(*ranks, forest.size(), renumbered);
    drop_excess(forest, renumbered, step.oracle.max_elements, old_size);
    Received received;
    step.oracle.importance = std::vector<float>();
    if (!importance) step.q = std::vector<float>();
    if (step.reusable_buffer && step.reusable_buffer->capacity() >= forest.size())
        received.irradiance = std::move(*step.reusable_buffer);
    else if (step.reusable_buffer)
        *step.reusable_buffer = std::vector<Rgb>();
    const auto convert_all = renumbered.are_simple() ? convert<true> : convert<false>;
    const ElementRange own = shares_conversion
                                 ? part_of_rank(*ranks, forest.size(), static_cast<std::size_t>(ranks->rank()))
                                 : ElementRange{0, forest.size()};
    convert_all(forest, step, units, renumbered, own, received);
    if (shares_conversion) {
        ReceivedBits bits(received);
        share_parts(*ranks, forest.size(), bits);
    }
    if (importance && !step.importance_at_patches)
        blend(forest, step, allocation, *importance, payload, old_size, received.importance);
    if (importance) received.part_importance = found_by_parts(step, allocation, *importance, old_size);
    push_pull(forest, step, received);
    received.shot_power = payload.power;
    received.payloads = payload.histogram;
    return received;
}

}  // namespace interflect::detail
