#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "interflect/base/memory/address_space.h"

namespace interflect::detail {

/// Zero-initialised array that never moves: threads can fill new entries while others read old ones. Pages are
/// allocated on first access.
template <class T>
class StableArray {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// @param large_pages  Whether to prefer pages of 2 MiB. Pages of 4 KiB suit arrays with few entries in use.
    /// @throws AddressSpaceError
    explicit StableArray(std::size_t capacity = 0, bool large_pages = true) : capacity_(capacity) {
        if (capacity == 0) return;
        void* memory =
            ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory == MAP_FAILED) throw AddressSpaceError(bytes());
        data_ = static_cast<T*>(memory);
        ::madvise(memory, bytes(), large_pages ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);  // fewer TLB misses; may fail
    }
    ~StableArray() {
        if (data_) ::munmap(data_, bytes());
    }
    StableArray(StableArray&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), capacity_(std::exchange(other.capacity_, 0)) {}
    StableArray& operator=(StableArray&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(capacity_, other.capacity_);
        return *this;
    }

    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    std::size_t capacity() const { return capacity_; }

    /// Frees the whole pages within a range, which become zero again.
    void release(std::size_t begin, std::size_t end) {
        constexpr std::size_t page = 4096;
        const std::size_t first = (begin * sizeof(T) + page - 1) / page * page, last = end * sizeof(T) / page * page;
        if (first < last) ::madvise(reinterpret_cast<char*>(data_) + first, last - first, MADV_DONTNEED);
    }

  private:
    std::size_t bytes() const { return capacity_ * sizeof(T); }
    T* data_ = nullptr;
    std::size_t capacity_ = 0;
};

}  // namespace interflect::detail
