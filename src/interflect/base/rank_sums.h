#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/ranks.h"

namespace interflect::detail {

/// Elements with a sum other than 0, as bytes: differences of their indices and the terms, seven bits in a byte
/// (LEB128).
class SparseSums {
  public:
    explicit SparseSums(std::size_t terms) : terms_(terms) {}

    /// @param element  Above all before.
    void append(std::size_t element, std::span<const std::int64_t> sums) {
        std::uint64_t any = 0;
        for (const std::int64_t s : sums) any |= static_cast<std::uint64_t>(s);
        if (any == 0) return;
        append(element - next_);
        for (const std::int64_t s : sums) append(static_cast<std::uint64_t>(s));
        next_ = element + 1;
    }
    const Ranks::Bytes& bytes() const { return bytes_; }

    /// Calls body(element, sums) for the elements of `bytes`.
    template <class Body>
    void for_each(std::span<const std::byte> bytes, const Body& body) const {
        std::vector<std::int64_t> sums(terms_);
        std::size_t at = 0, element = 0;
        const auto number = [&] {
            std::uint64_t value = 0;
            for (int shift = 0;; shift += 7) {
                const auto byte = static_cast<std::uint64_t>(bytes[at++]);
                value |= (byte & 127) << shift;
                if (byte < 128) return value;
            }
        };
        for (; at < bytes.size(); ++element) {
            element += number();
            for (std::int64_t& s : sums) s = static_cast<std::int64_t>(number());
            body(element, std::span<const std::int64_t>(sums));
        }
    }

  private:
    void append(std::uint64_t value) {
        for (; value >= 128; value >>= 7) bytes_.push_back(static_cast<std::byte>(value | 128));
        bytes_.push_back(static_cast<std::byte>(value));
    }

    std::size_t terms_, next_ = 0;
    Ranks::Bytes bytes_;
};

/// Adds the sums of all ranks. Rank r does this for the r-th part of the elements and sends the results to the others.
/// @param take  take(element, sums) moves the sums of this process there.
/// @param add   add(element, sums) receives the sums over all ranks.
template <class Take, class Add>
void add_over_ranks(Ranks& ranks, std::size_t elements, std::size_t terms, const Take& take, const Add& add) {
    const auto count = static_cast<std::size_t>(ranks.count()), own = static_cast<std::size_t>(ranks.rank());
    const auto begin_of = [&](std::size_t r) { return elements * r / count; };
    std::vector<std::int64_t> sums(terms);
    std::vector<Ranks::Bytes> parts;
    for (std::size_t r = 0; r < count; ++r) {
        SparseSums part(terms);
        for (std::size_t e = begin_of(r); e < begin_of(r + 1); ++e) {
            take(e, std::span(sums));
            part.append(e - begin_of(r), sums);
        }
        parts.push_back(part.bytes());
    }
    std::vector<std::int64_t> of_all((begin_of(own + 1) - begin_of(own)) * terms);
    const SparseSums reader(terms);
    for (const Ranks::Bytes& bytes : ranks.exchange(parts))
        reader.for_each(bytes, [&](std::size_t e, std::span<const std::int64_t> of_rank) {
            for (std::size_t i = 0; i < terms; ++i) of_all[e * terms + i] += of_rank[i];
        });
    SparseSums result(terms);
    for (std::size_t e = 0; e < of_all.size() / terms; ++e)
        result.append(e, std::span(of_all).subspan(e * terms, terms));
    const std::vector<Ranks::Bytes> results = ranks.gather(result.bytes());
    for (std::size_t r = 0; r < count; ++r)
        reader.for_each(results[r],
                        [&](std::size_t e, std::span<const std::int64_t> all) { add(begin_of(r) + e, all); });
}

/// Returns the values of all ranks, in their order.
template <class T>
std::vector<T> gather_over_ranks(Ranks& ranks, std::span<const T> values) {
    std::vector<T> all;
    for (const Ranks::Bytes& bytes : ranks.gather(std::as_bytes(values))) {
        std::array<std::byte, sizeof(T)> of_value;
        for (auto at = bytes.begin(); at != bytes.end(); at += sizeof(T)) {
            std::copy_n(at, sizeof(T), of_value.begin());
            all.push_back(std::bit_cast<T>(of_value));
        }
    }
    return all;
}

/// Returns the value of rank 0. @param ranks  Null: this process is alone.
template <class T>
T of_first_rank(Ranks* ranks, T value) {
    if (ranks) ranks->broadcast(std::as_writable_bytes(std::span(&value, 1)));
    return value;
}

}  // namespace interflect::detail
