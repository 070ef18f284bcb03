#include "interflect/elements/forest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <thread>
#include <tuple>
#include <utility>

#include "interflect/core.h"
#include "interflect/scene/core/geometry_fingerprint.h"

namespace interflect::detail {

namespace {

std::size_t valid_capacity(std::size_t capacity, std::size_t patches) {
    constexpr std::size_t end = 0xfffffffeu;  // larger numbers are reserved
    if (capacity < patches || capacity >= end)
        throw InputError(
            fmt::format("a forest of at most {} elements: expected at least the {} patches and less than {}", capacity,
                        patches, end));
    return capacity;
}

}  // namespace

ElementForest::ElementForest(const Scene& scene, std::size_t capacity)
    : scene_fingerprint_(geometry_fingerprint(scene)),
      patch_count_(static_cast<std::uint32_t>(scene.patches.size())),
      nodes_(valid_capacity(capacity, scene.patches.size())),
      blocks_((capacity - scene.patches.size()) / 4) {
    geometry_.resize(scene.patches.size());
    parallel_for_ranges(scene.patches.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            geometry_[i] = PatchGeometry(scene, scene.patches[i]);
            nodes_[i] = {no_element, geometry_[i].area()};
        }
    });
    size_ = patch_count();
    generations_.push_back(patch_count());
}

void ElementForest::require_made_for(const Scene& scene) const {
    detail::require_made_for(scene, scene_fingerprint_, "the forest");
}

int ElementForest::level(ElementIndex e) const { return (std::bit_width(path(e)) - 1) / 2; }

ElementIndex ElementForest::at_path(PatchIndex patch, std::uint32_t path) const {
    ElementIndex e = patch;
    for (int digit = (std::bit_width(path) - 1) / 2 - 1; digit >= 0 && e != no_element; --digit) {
        const ElementIndex child = first_child(e);
        e = child == no_element ? no_element : child + (path >> (2 * digit) & 3u);
    }
    return e;
}

Cell ElementForest::cell(ElementIndex e) const {
    const bool triangle = geometry_[patch(e)].is_triangle();
    const std::uint32_t way = path(e);
    Cell cell;
    for (int digit = level(e) - 1; digit >= 0; --digit) cell = cell.child(way >> (2 * digit) & 3u, triangle);
    return cell;
}

std::vector<ElementIndex> ElementForest::leaves() const {
    std::vector<ElementIndex> leaves;
    for (ElementIndex e{0}; e < size(); ++e)
        if (is_leaf(e)) leaves.push_back(e);
    return leaves;
}

ElementIndex ElementForest::leaf_below(ElementIndex e, Cell cell, Parameters p, std::uint32_t limit) const {
    const bool triangle = geometry_[patch(e)].is_triangle();
    for (ElementIndex child = first_child(e); child < limit; child = first_child(e)) {
        const unsigned k = cell.child_at(p, triangle);
        cell = cell.child(k, triangle);
        e = child + k;
    }
    return e;
}

ElementIndex ElementForest::subdivide(ElementIndex e) {
    std::atomic_ref<std::uint32_t> slot(nodes_[e].first_child.value);
    std::uint32_t state = none;
    if (level(e) >= deepest_level || !slot.compare_exchange_strong(state, being_made, std::memory_order_acquire)) {
        while (state == being_made) {  // another thread makes the children, which takes tens of nanoseconds
            std::this_thread::yield();
            state = slot.load(std::memory_order_acquire);
        }
        return ElementIndex(state);
    }
    const std::uint32_t first = size_.fetch_add(4, std::memory_order_acq_rel);
    if (first + 4 > capacity()) {
        size_.fetch_sub(4, std::memory_order_acq_rel);
        slot.store(none, std::memory_order_release);
        return no_element;
    }
    const PatchGeometry& geometry = geometry_[patch(e)];
    const Cell parent = cell(e);
    blocks_[(first - patch_count()) / 4] = {e, patch(e), path(e)};
    for (std::uint32_t k = 0; k < 4; ++k) {
        const Cell cell = parent.child(k, geometry.is_triangle());
        // The Jacobian at the centre gives the exact area, because the Jacobian is linear.
        const float area = geometry.jacobian(cell.centre(geometry.is_triangle())) * cell.size * cell.size;
        nodes_[first + k] = {no_element, geometry.is_triangle() ? 0.5f * area : area};
    }
    slot.store(first, std::memory_order_release);
    return ElementIndex(first);
}

std::vector<ElementIndex> ElementForest::put_in_order(std::uint32_t first) {
    const std::uint32_t last = size();
    const auto number = [&](std::uint32_t e) { return (e - patch_count()) / 4; };
    struct Siblings {
        Block block;
        std::array<Node, 4> nodes;
        std::uint32_t first;
    };
    // Sort copies of the new blocks
    std::vector<Siblings> made;
    made.reserve((last - first) / 4);
    for (std::uint32_t e = first; e < last; e += 4)
        made.push_back({blocks_[number(e)], {nodes_[e], nodes_[e + 1], nodes_[e + 2], nodes_[e + 3]}, e});
    parallel_sort(made, [](const Siblings& a, const Siblings& b) {
        const auto key = [](const Siblings& s) {
            return std::tuple(std::bit_width(s.block.parent_path), s.block.patch, s.block.parent_path);
        };
        return key(a) < key(b);
    });

    // Write them back with new indices of parents and children
    std::vector<ElementIndex> renumbered(last - first);
    for (std::uint32_t i = 0; i < renumbered.size(); ++i)
        renumbered[made[i / 4].first + i % 4 - first] = ElementIndex(first + i);
    const auto new_number = [&](ElementIndex e) { return e == no_element || e < first ? e : renumbered[e - first]; };
    for (std::uint32_t e = first; e < last; e += 4) {
        const Siblings& s = made[(e - first) / 4];
        const ElementIndex parent = new_number(s.block.parent);
        blocks_[number(e)] = {parent, s.block.patch, s.block.parent_path};
        for (std::uint32_t k = 0; k < 4; ++k) nodes_[e + k] = {new_number(s.nodes[k].first_child), s.nodes[k].area};
        nodes_[parent].first_child = ElementIndex(e);
        if (parent >= generations_.back()) generations_.push_back(e);
    }
    if (last > first) generations_.push_back(last);
    std::vector<ElementIndex> old_numbers = std::move(renumbered);  // the inverse, in the same memory
    for (std::uint32_t i = 0; i < old_numbers.size(); ++i) old_numbers[i] = ElementIndex(made[i / 4].first + i % 4);
    return old_numbers;
}

void ElementForest::rebuild(std::span<const ElementIndex> parents) {
    for (const ElementIndex parent : parents) {
        const std::uint32_t next = size();
        if (parent >= next || subdivide(parent) != next)
            throw InputError(fmt::format("element {} cannot be subdivided there", parent));
        if (parent >= generations_.back()) generations_.push_back(next);
    }
    if (!parents.empty()) generations_.push_back(size());
}

std::vector<ElementIndex> ElementForest::subdivided() const {
    std::vector<ElementIndex> parents;
    parents.reserve((size() - patch_count()) / 4);
    for (std::uint32_t e = patch_count(); e < size(); e += 4) parents.push_back(parent(ElementIndex(e)));
    return parents;
}

ElementIndex ElementForest::drop_last_siblings() {
    const ElementIndex parent = this->parent(ElementIndex(size() - 1));
    nodes_[parent].first_child = no_element;
    size_ -= 4;
    if (generations_.back() > size()) generations_.back() = size();
    if (generations_.size() > 1 && generations_.end()[-2] == size()) generations_.pop_back();
    return parent;
}

}  // namespace interflect::detail
