#pragma once
/// Index types, which prevent confusion of elements with patches.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace interflect {

/// Invalid index.
inline constexpr std::uint32_t none = 0xffffffffu;

/// Index into Scene::patches; converts to an integer, but no integer converts to it without a cast.
struct PatchIndex {
    std::uint32_t value = none;

    constexpr PatchIndex() = default;
    template <std::integral I>
    constexpr explicit PatchIndex(I i) : value(static_cast<std::uint32_t>(i)) {}
    constexpr operator std::uint32_t() const { return value; }

    constexpr PatchIndex& operator++() {
        ++value;
        return *this;
    }
    template <std::integral I>
    constexpr PatchIndex& operator+=(I i) {
        return *this = *this + i;
    }
    /// The patch `i` places after this one.
    template <std::integral I>
    friend constexpr PatchIndex operator+(PatchIndex p, I i) {
        return PatchIndex(p.value + static_cast<std::uint32_t>(i));
    }
};

/// Index into the vectors of a Solution. Elements are patches and their pieces. A patch index converts to an element
/// index, but an element index does not convert to a patch index.
struct ElementIndex {
    std::uint32_t value = none;

    constexpr ElementIndex() = default;
    constexpr ElementIndex(PatchIndex root) : value(root.value) {}
    template <std::integral I>
    constexpr explicit ElementIndex(I i) : value(static_cast<std::uint32_t>(i)) {}
    constexpr operator std::uint32_t() const { return value; }
    explicit operator PatchIndex() const = delete;

    constexpr ElementIndex& operator++() {
        ++value;
        return *this;
    }
    template <std::integral I>
    constexpr ElementIndex& operator+=(I i) {
        return *this = *this + i;
    }
    /// The element `i` places after this one: siblings follow each other.
    template <std::integral I>
    friend constexpr ElementIndex operator+(ElementIndex e, I i) {
        return ElementIndex(e.value + static_cast<std::uint32_t>(i));
    }
};

inline constexpr PatchIndex no_patch{};
inline constexpr ElementIndex no_element{};

/// A vector with one entry per patch, which elements cannot index.
template <class T>
struct PerPatch : std::vector<T> {
    using std::vector<T>::vector;
    using std::vector<T>::operator[];
    T& operator[](ElementIndex) = delete;
    const T& operator[](ElementIndex) const = delete;
    T& operator[](PatchIndex i) { return std::vector<T>::operator[](i.value); }
    const T& operator[](PatchIndex i) const { return std::vector<T>::operator[](i.value); }
};

}  // namespace interflect
