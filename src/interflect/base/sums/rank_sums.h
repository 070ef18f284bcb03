#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "interflect/base/sums/packed_sums.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/ranks.h"

namespace interflect::detail {

/// A range of elements [begin, end).
struct ElementRange {
    std::size_t begin = 0, end = 0;
};
/// Returns the part of the elements that a rank adds.
inline ElementRange part_of_rank(const Ranks& ranks, std::size_t elements, std::size_t rank) {
    const auto count = static_cast<std::size_t>(ranks.count());
    return {elements * rank / count, elements * (rank + 1) / count};
}

/// Adds the integer sums of all ranks in the rank to which an element belongs. The others then have 0.
/// @param sums  Has terms(); is_zero(element); read(element, row); take(element, row), which also zeroes;
/// add(element, row). A row has terms() numbers. Several threads call these for different elements.
template <class Sums>
void add_in_parts(Ranks& ranks, std::size_t elements, Sums& sums) {
    const auto count = static_cast<std::size_t>(ranks.count()), own = static_cast<std::size_t>(ranks.rank());
    std::vector<Ranks::Bytes> parts(count);
    for (std::size_t r = 0; r < count; ++r) {
        if (r == own) continue;
        const auto [begin, end] = part_of_rank(ranks, elements, r);
        parts[r] = PackedSums(begin, end, sums.terms(), [&](std::size_t e, std::span<std::int64_t> row) {
                       if (sums.is_zero(e)) return false;
                       sums.take(e, row);
                       return true;
                   }).bytes();
    }
    std::vector<std::span<const std::byte>> of_others;
    const std::vector<Ranks::Bytes> received = ranks.exchange(parts);
    for (std::size_t r = 0; r < count; ++r)
        if (r != own) of_others.emplace_back(received[r]);
    const auto [begin, end] = part_of_rank(ranks, elements, own);
    PackedSums::unpack(of_others, begin, end, sums.terms(),
                       [&](std::size_t e, std::span<const std::int64_t> row) { sums.add(e, row); });
}

/// Adds the values of each rank's part in the other ranks. @param values  As in add_in_parts(), without take().
template <class Values>
void share_parts(Ranks& ranks, std::size_t elements, Values& values) {
    const auto own = static_cast<std::size_t>(ranks.rank());
    const auto [own_begin, own_end] = part_of_rank(ranks, elements, own);
    const PackedSums packed(own_begin, own_end, values.terms(), [&](std::size_t e, std::span<std::int64_t> row) {
        if (values.is_zero(e)) return false;
        values.read(e, row);
        return true;
    });
    const std::vector<Ranks::Bytes> of_ranks = ranks.gather(packed.bytes());
    for (std::size_t r = 0; r < of_ranks.size(); ++r) {
        if (r == own) continue;
        const std::span<const std::byte> part = of_ranks[r];
        const auto [begin, end] = part_of_rank(ranks, elements, r);
        PackedSums::unpack(std::span(&part, 1), begin, end, values.terms(),
                           [&](std::size_t e, std::span<const std::int64_t> row) { values.add(e, row); });
    }
}

/// Adds the integer sums of all ranks in each of them. @param sums  As in add_in_parts().
template <class Sums>
void add_over_ranks(Ranks& ranks, std::size_t elements, Sums& sums) {
    add_in_parts(ranks, elements, sums);
    share_parts(ranks, elements, sums);
}

/// Returns the values of all ranks, in their order.
template <class T>
std::vector<T> gather_over_ranks(Ranks& ranks, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all;
    for (const Ranks::Bytes& bytes : ranks.gather(std::as_bytes(values))) {
        const std::size_t before = all.size();
        all.resize(before + bytes.size() / sizeof(T));
        if (!bytes.empty()) std::memcpy(static_cast<void*>(&all[before]), bytes.data(), bytes.size());
    }
    return all;
}

/// Computes `size` values for each of `items` independent items, which the ranks share.
/// @param work   work(item, values) sets the values. Called by several threads.
/// @param ranks  Null: this process is alone.
template <class T, class Work>
std::vector<T> divide_over_ranks(Ranks* ranks, std::size_t items, std::size_t size, const Work& work) {
    std::vector<T> all(items * size);
    parallel_for_own_ranges(ranks, all.size(), size, [&](std::size_t begin, std::size_t) {
        work(begin / size, std::span(all).subspan(begin, size));
    });
    collect_ranges(ranks, std::span(all), size, Destination::all_ranks);
    return all;
}

/// Computes parallel_sum() with the ranges shared by the ranks. Equal bits for any number of ranks.
template <class T, class Body>
T parallel_sum(Ranks* ranks, std::size_t count, std::size_t grain, const T& zero, const Body& body) {
    const std::vector<T> parts =
        divide_over_ranks<T>(ranks, (count + grain - 1) / grain, 1, [&](std::size_t range, std::span<T> part) {
            part[0] = body(range * grain, std::min(count, (range + 1) * grain));
        });
    T sum = zero;
    for (const T& part : parts) sum += part;
    return sum;
}

/// Returns the value of rank 0. @param ranks  Null: this process is alone.
template <class T>
T of_first_rank(Ranks* ranks, T value) {
    if (ranks) ranks->broadcast(std::as_writable_bytes(std::span(&value, 1)));
    return value;
}

}  // namespace interflect::detail
