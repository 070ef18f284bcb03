#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/ranks.h"

namespace interflect::detail {

/// Integer sums of many elements in few bytes. A block of 64 elements has a bit for each nonzero element, the width of
/// each term in bytes, and the terms of the nonzero elements.
class PackedSums {
  public:
    /// Elements per task. The bytes begin with the offset of each task.
    static constexpr std::size_t task_elements = std::size_t{1} << 14;

    /// @param row  row(element, terms) fills the terms of an element in [begin, end), or returns false if all are 0.
    /// Called by several threads.
    template <class Row>
    PackedSums(std::size_t begin, std::size_t end, std::size_t terms, const Row& row) {
        std::vector<Ranks::Bytes> of_tasks(tasks_of(end - begin));
        parallel_for_ranges(end - begin, task_elements, [&](std::size_t first, std::size_t last) {
            of_tasks[first / task_elements] = packed(begin + first, begin + last, terms, row);
        });
        std::uint64_t offset = of_tasks.size() * sizeof(offset);
        for (const Ranks::Bytes& task : of_tasks) append(&offset, sizeof(offset)), offset += task.size();
        for (const Ranks::Bytes& task : of_tasks) append(task.data(), task.size());
    }
    const Ranks::Bytes& bytes() const { return bytes_; }

    /// Calls add(element, terms) for the elements of [begin, end) with a nonzero sum, on several threads.
    /// @param parts  Packed sums of these elements. Calls for one element follow this order, on one thread.
    template <class Add>
    static void unpack(std::span<const std::span<const std::byte>> parts, std::size_t begin, std::size_t end,
                       std::size_t terms, const Add& add) {
        parallel_for_ranges(end - begin, task_elements, [&](std::size_t first, std::size_t last) {
            for (const std::span<const std::byte> part : parts) {
                std::uint64_t offset = 0;
                std::memcpy(&offset, part.data() + first / task_elements * sizeof(offset), sizeof(offset));
                unpack(part.data() + offset, begin + first, begin + last, terms, add);
            }
        });
    }

  private:
    static_assert(std::endian::native == std::endian::little);
    static constexpr std::size_t block = 64;

    static std::size_t tasks_of(std::size_t elements) { return (elements + task_elements - 1) / task_elements; }
    static std::size_t bytes_for(std::uint64_t value) {
        return (static_cast<std::size_t>(std::bit_width(value)) + 7) / 8;
    }

    void append(const void* data, std::size_t size) {
        const auto* const first = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }

    template <class Row>
    static Ranks::Bytes packed(std::size_t begin, std::size_t end, std::size_t terms, const Row& row) {
        Ranks::Bytes bytes;
        std::vector<std::int64_t> rows(block * terms);
        std::vector<std::uint64_t> used(terms);  // bits that occur in each term of the block
        std::size_t size = 0;
        for (std::size_t first = begin; first < end; first += block) {
            const std::size_t count = std::min(block, end - first);
            std::uint64_t present = 0;
            std::ranges::fill(used, 0);
            for (std::size_t i = 0; i < count; ++i) {
                const std::span<std::int64_t> sums(&rows[i * terms], terms);
                if (!row(first + i, sums)) continue;
                std::uint64_t any = 0;
                for (std::size_t t = 0; t < terms; ++t) {
                    any |= static_cast<std::uint64_t>(sums[t]);
                    used[t] |= static_cast<std::uint64_t>(sums[t]);
                }
                present |= std::uint64_t{any != 0} << i;
            }
            // Each term is written as eight bytes; the next term overwrites the unused ones.
            const auto nonzero = static_cast<std::size_t>(std::popcount(present));
            bytes.resize(size + sizeof(present) + terms + (nonzero * terms + 1) * sizeof(std::int64_t));
            std::byte* at = bytes.data() + size;
            std::memcpy(at, &present, sizeof(present)), at += sizeof(present);
            if (present != 0)
                for (const std::uint64_t bits : used) *at++ = static_cast<std::byte>(bytes_for(bits));
            for (std::uint64_t left = present; left != 0; left &= left - 1) {
                const std::int64_t* const sums = &rows[static_cast<std::size_t>(std::countr_zero(left)) * terms];
                for (std::size_t t = 0; t < terms; ++t) {
                    std::memcpy(at, &sums[t], sizeof(sums[t]));
                    at += bytes_for(used[t]);
                }
            }
            size = static_cast<std::size_t>(at - bytes.data());
        }
        bytes.resize(size + sizeof(std::int64_t));  // unpack() reads beyond the last term
        return bytes;
    }

    template <class Add>
    static void unpack(const std::byte* at, std::size_t begin, std::size_t end, std::size_t terms, const Add& add) {
        std::vector<std::int64_t> sums(terms);
        std::vector<std::size_t> sizes(terms);
        std::vector<std::uint64_t> masks(terms);
        for (std::size_t first = begin; first < end; first += block) {
            std::uint64_t present = 0;
            std::memcpy(&present, at, sizeof(present)), at += sizeof(present);
            if (present == 0) continue;
            for (std::size_t t = 0; t < terms; ++t) {
                sizes[t] = static_cast<std::size_t>(*at++);
                masks[t] = sizes[t] == 0 ? 0 : ~std::uint64_t{0} >> (64 - 8 * sizes[t]);
            }
            for (std::uint64_t left = present; left != 0; left &= left - 1) {
                for (std::size_t t = 0; t < terms; ++t) {
                    std::uint64_t value = 0;
                    std::memcpy(&value, at, sizeof(value)), at += sizes[t];
                    sums[t] = static_cast<std::int64_t>(value & masks[t]);
                }
                add(first + static_cast<std::size_t>(std::countr_zero(left)), std::span<const std::int64_t>(sums));
            }
        }
    }

    Ranks::Bytes bytes_;
};

}  // namespace interflect::detail
