#include "interflect/elements/forest.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>
#include <thread>

namespace interflect {

ElementForest::ElementForest(const Scene& scene, std::size_t capacity)
    : first_child_(capacity), parent_(capacity), patch_(capacity), path_(capacity), area_(capacity) {
    assert(capacity >= scene.patches.size() && capacity < being_made);
    geometry_.reserve(scene.patches.size());
    for (const Patch& p : scene.patches) geometry_.emplace_back(scene, p);
    for (std::uint32_t i = 0; i < patch_count(); ++i) {
        first_child_[i] = none;
        parent_[i] = none;
        patch_[i] = i;
        path_[i] = 1;
        area_[i] = geometry_[i].area();
    }
    size_ = patch_count();
}

int ElementForest::level(std::uint32_t e) const { return (std::bit_width(path_[e]) - 1) / 2; }

Cell ElementForest::cell(std::uint32_t e) const {
    const bool triangle = geometry_[patch_[e]].is_triangle();
    Cell cell;
    for (int digit = level(e) - 1; digit >= 0; --digit) cell = cell.child(path_[e] >> (2 * digit) & 3u, triangle);
    return cell;
}

std::vector<std::uint32_t> ElementForest::leaves() const {
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t e = 0; e < size(); ++e)
        if (is_leaf(e)) leaves.push_back(e);
    return leaves;
}

std::uint32_t ElementForest::leaf_below(std::uint32_t e, Cell cell, Parameters p, std::uint32_t limit) const {
    const bool triangle = geometry_[patch_[e]].is_triangle();
    for (std::uint32_t child = first_child(e); child < limit; child = first_child(e)) {
        const unsigned k = cell.child_at(p, triangle);
        cell = cell.child(k, triangle);
        e = child + k;
    }
    return e;
}

std::uint32_t ElementForest::subdivide(std::uint32_t e) {
    std::atomic_ref<std::uint32_t> slot(first_child_[e]);
    std::uint32_t state = none;
    if (level(e) >= deepest_level || !slot.compare_exchange_strong(state, being_made, std::memory_order_acquire)) {
        while (state == being_made) {  // another thread is at it, for some tens of nanoseconds
            std::this_thread::yield();
            state = slot.load(std::memory_order_acquire);
        }
        return state;
    }
    const std::uint32_t first = size_.fetch_add(4, std::memory_order_acq_rel);
    if (first + 4 > capacity()) {
        size_.fetch_sub(4, std::memory_order_acq_rel);
        slot.store(none, std::memory_order_release);
        return none;
    }
    const PatchGeometry& geometry = geometry_[patch_[e]];
    const Cell parent = cell(e);
    for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t c = first + k;
        const Cell cell = parent.child(k, geometry.is_triangle());
        first_child_[c] = none;
        parent_[c] = e;
        patch_[c] = patch_[e];
        path_[c] = path_[e] << 2 | k;
        // Exact: the jacobian is linear, so its mean over the cell is its value at the centre.
        area_[c] = geometry.jacobian(cell.centre(geometry.is_triangle())) * cell.size * cell.size *
                   (geometry.is_triangle() ? 0.5f : 1.0f);
    }
    slot.store(first, std::memory_order_release);
    return first;
}

std::vector<std::uint32_t> ElementForest::put_in_order(std::uint32_t first) {
    const std::uint32_t last = size();
    std::vector<std::uint32_t> blocks((last - first) / 4);  // old first elements of the blocks, in their new order
    for (std::uint32_t b = 0; b < blocks.size(); ++b) blocks[b] = first + 4 * b;
    std::sort(blocks.begin(), blocks.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int level_a = level(a), level_b = level(b);
        if (level_a != level_b) return level_a < level_b;
        if (patch_[a] != patch_[b]) return patch_[a] < patch_[b];
        return path_[a] < path_[b];
    });

    std::vector<std::uint32_t> renumbered(last - first);
    struct Element {
        std::uint32_t first_child, parent, patch, path;
        float area;
    };
    std::vector<Element> moved(last - first);
    for (std::uint32_t i = 0; i < moved.size(); ++i) {
        const std::uint32_t old = blocks[i / 4] + i % 4;
        renumbered[old - first] = first + i;
        moved[i] = {first_child_[old], parent_[old], patch_[old], path_[old], area_[old]};
    }
    const auto new_number = [&](std::uint32_t e) { return e == none || e < first ? e : renumbered[e - first]; };
    for (std::uint32_t i = 0; i < moved.size(); ++i) {
        const std::uint32_t e = first + i;
        first_child_[e] = new_number(moved[i].first_child);
        parent_[e] = new_number(moved[i].parent);
        patch_[e] = moved[i].patch;
        path_[e] = moved[i].path;
        area_[e] = moved[i].area;
        if (i % 4 == 0) first_child_[parent_[e]] = e;
    }
    return renumbered;
}

}  // namespace interflect
