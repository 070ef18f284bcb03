#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "interflect/base/sums/packed_sums.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/ranks.h"

namespace interflect::detail {

/// Adds the integer sums of all ranks. Rank r adds the r-th part of the elements and sends the results to the others.
/// @param sums  Has terms(); read(element, row); take(element, row), which also zeroes; add(element, row). A row has
/// terms() numbers. Several threads call these for different elements.
template <class Sums>
void add_over_ranks(Ranks& ranks, std::size_t elements, Sums& sums) {
    using Row = std::span<std::int64_t>;
    using ConstRow = std::span<const std::int64_t>;
    const auto count = static_cast<std::size_t>(ranks.count()), own = static_cast<std::size_t>(ranks.rank());
    const auto begin_of = [&](std::size_t r) { return elements * r / count; };
    const auto add = [&](std::size_t e, ConstRow row) { sums.add(e, row); };

    // Send each other rank the sums of its part of the elements
    std::vector<Ranks::Bytes> parts(count);
    for (std::size_t r = 0; r < count; ++r)
        if (r != own)
            parts[r] = PackedSums(begin_of(r), begin_of(r + 1), sums.terms(), [&](std::size_t e, Row row) {
                           sums.take(e, row);
                       }).bytes();
    // Add the received sums to the own part
    std::vector<std::span<const std::byte>> of_others;
    const std::vector<Ranks::Bytes> received = ranks.exchange(parts);
    for (std::size_t r = 0; r < count; ++r)
        if (r != own) of_others.emplace_back(received[r]);
    PackedSums::unpack(of_others, begin_of(own), begin_of(own + 1), sums.terms(), add);

    // Exchange the results of all parts
    const PackedSums result(begin_of(own), begin_of(own + 1), sums.terms(),
                            [&](std::size_t e, Row row) { sums.read(e, row); });
    const std::vector<Ranks::Bytes> results = ranks.gather(result.bytes());
    for (std::size_t r = 0; r < count; ++r) {
        const std::span<const std::byte> part = results[r];
        if (r != own) PackedSums::unpack(std::span(&part, 1), begin_of(r), begin_of(r + 1), sums.terms(), add);
    }
}

/// Returns the values of all ranks, in their order.
template <class T>
std::vector<T> gather_over_ranks(Ranks& ranks, std::span<const T> values) {
    std::vector<T> all;
    for (const Ranks::Bytes& bytes : ranks.gather(std::as_bytes(values))) {
        all.reserve(all.size() + bytes.size() / sizeof(T));
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
            std::array<std::byte, sizeof(T)> of_value;
            std::memcpy(of_value.data(), &bytes[at], sizeof(T));
            all.push_back(std::bit_cast<T>(of_value));
        }
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
