#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/ranks.h"

namespace interflect::detail {

/// Loops that ranks share: range i of parallel_for_ranges() belongs to rank i % count, since neighbouring ranges take
/// similar time.

/// Calls body(begin, end) for the ranges of this rank. @param ranks  Null: all ranges.
template <class Body>
void parallel_for_own_ranges(const Ranks* ranks, std::size_t count, std::size_t grain, const Body& body) {
    if (!ranks) return parallel_for_ranges(count, grain, body);
    const auto first = static_cast<std::size_t>(ranks->rank()), step = static_cast<std::size_t>(ranks->count());
    const std::size_t all = (count + grain - 1) / grain, own = (all + step - 1 - first) / step;
    parallel_for_ranges(own, 1, [&](std::size_t i, std::size_t) {
        const std::size_t begin = (first + i * step) * grain;
        body(begin, std::min(count, begin + grain));
    });
}

/// Destination of the values of all ranges.
enum class Destination { first_rank, all_ranks };

/// Copies the values of each range from its rank to the destination. Collective.
/// @param ranks  Null: no effect. @param values  All values; the same number in all ranks.
template <class T>
void collect_ranges(Ranks* ranks, std::span<T> values, std::size_t grain, Destination destination) {
    static_assert(std::is_standard_layout_v<T> && !std::is_pointer_v<T>);
    if (!ranks) return;
    const auto count = static_cast<std::size_t>(ranks->count()), own = static_cast<std::size_t>(ranks->rank());
    const auto for_each_range = [&](std::size_t rank, const auto& visit) {
        for (std::size_t begin = rank * grain; begin < values.size(); begin += count * grain)
            visit(std::as_writable_bytes(values.subspan(begin, std::min(grain, values.size() - begin))));
    };
    Ranks::Bytes sent;
    for_each_range(own, [&](std::span<std::byte> range) { sent.insert(sent.end(), range.begin(), range.end()); });
    std::vector<Ranks::Bytes> received;
    if (destination == Destination::all_ranks) {
        received = ranks->gather(sent);
    } else {
        std::vector<Ranks::Bytes> parts(count);
        parts[0] = std::move(sent);
        received = ranks->exchange(parts);
        if (own != 0) return;
    }
    for (std::size_t rank = 0; rank < count; ++rank) {
        auto next = received[rank].begin();
        for_each_range(rank, [&](std::span<std::byte> range) {
            std::copy_n(next, range.size(), range.begin());
            next += static_cast<std::ptrdiff_t>(range.size());
        });
    }
}

}  // namespace interflect::detail
