#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/memory/stable_array.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/cell.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/indices.h"
#include "interflect/scene.h"

namespace interflect::detail {

inline constexpr std::size_t elements_per_task = 1 << 13;
/// Number of elements from which on memory is saved by more work for each element.
inline constexpr std::size_t many_elements = std::size_t{1} << 20;

/// Quadtrees over a scene's patches. Element i < patch_count() is the root of patch i; blocks of four siblings follow.
/// Threads may subdivide while others traverse; put_in_order() then makes indices independent of threads.
class ElementForest {
  public:
    static constexpr int deepest_level = 15;

    /// @param capacity  Maximum number of elements, in [patches, 2^32 - 2), for which address space is reserved.
    /// @throws InputError for another capacity or a vertex index out of range; AddressSpaceError.
    ElementForest(const Scene& scene, std::size_t capacity);

    /// Address space per element [bytes].
    static constexpr std::size_t reserved_per_element = 11;

    /// @throws InputError for a scene of other geometry.
    void require_made_for(const Scene& scene) const;

    std::uint32_t patch_count() const { return patch_count_; }
    std::uint32_t size() const { return size_.load(std::memory_order_acquire); }
    std::size_t capacity() const { return nodes_.capacity(); }

    PatchIndex patch(ElementIndex e) const { return is_root(e) ? PatchIndex(e.value) : block_of(e).patch; }
    ElementIndex parent(ElementIndex e) const { return is_root(e) ? no_element : block_of(e).parent; }
    float area(ElementIndex e) const { return nodes_[e].area; }  ///< [m^2]
    int level(ElementIndex e) const;
    /// Returns the path from the root. In binary, it is 1, followed by two bits for each level: the index of the child.
    std::uint32_t path(ElementIndex e) const {
        return is_root(e) ? 1 : block_of(e).parent_path << 2 | number_in_block(e);
    }
    /// Returns the element with this path(), or `none` if it does not exist.
    ElementIndex at_path(PatchIndex patch, std::uint32_t path) const;
    Cell cell(ElementIndex e) const;
    const PatchGeometry& geometry(PatchIndex patch) const { return geometry_[patch]; }
    void prefetch(ElementIndex e) const { __builtin_prefetch(&nodes_[e]); }
    void prefetch_geometry(PatchIndex patch) const {
        const char* geometry = reinterpret_cast<const char*>(&geometry_[patch]);
        __builtin_prefetch(geometry);
        __builtin_prefetch(geometry + 64);
    }

    ElementIndex first_child(ElementIndex e) const {
        const std::uint32_t child = std::atomic_ref(nodes_[e].first_child.value).load(std::memory_order_acquire);
        return child >= being_made ? no_element : ElementIndex(child);
    }
    bool is_leaf(ElementIndex e) const { return first_child(e) == no_element; }
    std::vector<ElementIndex> leaves() const;
    /// Returns the leaf that contains `p`, ignoring elements from `limit` on.
    ElementIndex leaf_at(PatchIndex root, Parameters p, std::uint32_t limit = none) const {
        return leaf_below(root, Cell(), p, limit);
    }
    /// Returns the leaf below `e` that contains `p`. The cell of `e` must contain `p`.
    ElementIndex leaf_below(ElementIndex e, Cell cell, Parameters p, std::uint32_t limit = none) const;

    /// Creates the children of `e` unless they exist. Thread-safe.
    /// @return  The first child, or `none` if the forest is full or `e` is at the deepest level.
    ElementIndex subdivide(ElementIndex e);

    /// Sorts the elements from `first` on by level, patch and path. Not thread-safe.
    /// @return  The old index of each element first + i.
    std::vector<ElementIndex> put_in_order(std::uint32_t first);

    /// Returns the divided elements in the order of their division, for rebuild().
    std::vector<ElementIndex> subdivided() const;
    /// Divides `parents` in this order. The forest must consist of roots only.
    /// @throws InputError if an element cannot be subdivided.
    void rebuild(std::span<const ElementIndex> parents);

    /// Removes the last four leaves of an ordered forest; returns their parent. Not thread-safe.
    ElementIndex drop_last_siblings();

    /// Calls body(first) for each block of siblings, parents before children. After put_in_order(), runs in parallel.
    template <class Body>
    void for_siblings_from_roots(const Body& body) const;
    /// Does the same with children before parents.
    template <class Body>
    void for_siblings_from_leaves(const Body& body) const;

  private:
    static constexpr std::uint32_t being_made = 0xfffffffeu;

    struct Node {
        ElementIndex first_child;
        float area;
    };
    struct Block {
        ElementIndex parent;
        PatchIndex patch;
        std::uint32_t parent_path;
    };

    static_assert((4 * sizeof(Node) + sizeof(Block)) / 4 == reserved_per_element);

    bool is_root(ElementIndex e) const { return e < patch_count(); }
    const Block& block_of(ElementIndex e) const { return blocks_[(e - patch_count()) / 4]; }
    std::uint32_t number_in_block(ElementIndex e) const { return (e - patch_count()) % 4; }

    template <class Body>
    static void for_siblings(std::uint32_t begin, std::uint32_t end, const Body& body);

    std::uint64_t scene_fingerprint_;
    PerPatch<PatchGeometry> geometry_;
    std::uint32_t patch_count_;
    /// First element of each generation, followed by the end of the last one. A generation contains no parent of its
    /// own elements, so its blocks can be processed in parallel.
    std::vector<std::uint32_t> generations_;
    std::atomic<std::uint32_t> size_{0};
    mutable StableArray<Node> nodes_;
    StableArray<Block> blocks_;
};

template <class Body>
void ElementForest::for_siblings(std::uint32_t begin, std::uint32_t end, const Body& body) {
    constexpr std::size_t at_once = 2048;
    parallel_for_ranges((end - begin) / 4, at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) body(ElementIndex(begin + 4 * i));
    });
}

template <class Body>
void ElementForest::for_siblings_from_roots(const Body& body) const {
    for (std::size_t g = 0; g + 1 < generations_.size(); ++g) for_siblings(generations_[g], generations_[g + 1], body);
    for (std::uint32_t first = generations_.back(); first < size(); first += 4) body(ElementIndex(first));
}

template <class Body>
void ElementForest::for_siblings_from_leaves(const Body& body) const {
    for (std::uint32_t end = size(); end > generations_.back(); end -= 4) body(ElementIndex(end - 4));
    for (std::size_t g = generations_.size() - 1; g > 0; --g) for_siblings(generations_[g - 1], generations_[g], body);
}

/// Initialises elements from `first` on with the values of their parents.
template <class T>
void inherit(const ElementForest& forest, std::uint32_t first, std::vector<T>& values) {
    values.resize(forest.size());
    for (ElementIndex e(first); e < forest.size(); ++e) values[e] = values[forest.parent(e)];
}

/// Removes the values of inner elements.
template <class T>
void keep_leaves(const ElementForest& forest, std::vector<T>& values) {
    std::size_t count = 0;
    for (ElementIndex e{0}; e < values.size(); ++e)
        if (forest.is_leaf(e)) values[count++] = values[e];
    values.resize(count);
    values.shrink_to_fit();
}
/// Reverses keep_leaves() for a forest that then had `elements` elements. Values of inner and new elements are 0.
template <class T>
void expand_leaves(const ElementForest& forest, std::uint32_t elements, std::vector<T>& values) {
    std::vector<T> expanded(forest.size(), T(0));
    auto next = values.begin();
    for (ElementIndex e{0}; e < elements; ++e)
        if (forest.first_child(e) >= elements) expanded[e] = *next++;
    values = std::move(expanded);
}

/// Adds each parent's value per area to its children.
template <class T>
void push(const ElementForest& forest, std::vector<T>& values) {
    forest.for_siblings_from_roots([&](ElementIndex first) {
        const T from_parent = values[forest.parent(first)];
        for (ElementIndex e = first; e < first + 4; ++e) values[e] += from_parent;
    });
}

/// Sets inner elements to the area-weighted mean of their children.
template <class T>
void pull(const ElementForest& forest, std::vector<T>& values) {
    forest.for_siblings_from_leaves([&](ElementIndex first) {
        T sum = values[first] * forest.area(first);
        float area = forest.area(first);
        for (ElementIndex e = first + 1; e < first + 4; ++e) {
            sum += values[e] * forest.area(e);
            area += forest.area(e);
        }
        values[forest.parent(first)] = sum / area;
    });
}

}  // namespace interflect::detail
