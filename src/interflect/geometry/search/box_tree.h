#pragma once

#include <ImathBox.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

struct Boxed {
    Imath::Box3f box;  ///< Bounds of the element; after arrange_box_tree(), of its subtree.
    std::uint32_t index = 0;
};

/// Arranges a bounding volume hierarchy in place: the root is in the middle, between its subtrees.
inline void arrange_box_tree(std::span<Boxed> elements) {
    if (elements.empty()) return;
    Imath::Box3f all, doubled_centres;
    for (const Boxed& e : elements) {
        all.extendBy(e.box);
        doubled_centres.extendBy(e.box.min + e.box.max);
    }
    const auto axis = static_cast<int>(doubled_centres.majorAxis());
    const std::size_t middle = elements.size() / 2;
    std::nth_element(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(middle), elements.end(),
                     [axis](const Boxed& a, const Boxed& b) {
                         return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
                     });
    const auto arrange_first = [&] { arrange_box_tree(elements.first(middle)); };
    const auto arrange_second = [&] { arrange_box_tree(elements.subspan(middle + 1)); };
    constexpr std::size_t worth_a_task = 1 << 13;
    if (elements.size() >= worth_a_task) {
        parallel_invoke(arrange_first, arrange_second);
    } else {
        arrange_first();
        arrange_second();
    }
    elements[middle].box = all;
}

/// Calls visit(index) for each element if reaches(box) is true for the boxes of all subtrees that contain it. These
/// boxes may be larger than the element's own.
template <class Reaches, class Visit>
void visit_box_tree(std::span<const Boxed> tree, const Reaches& reaches, const Visit& visit) {
    if (tree.empty()) return;
    const std::size_t middle = tree.size() / 2;
    if (!reaches(tree[middle].box)) return;
    visit(tree[middle].index);
    visit_box_tree(tree.first(middle), reaches, visit);
    visit_box_tree(tree.subspan(middle + 1), reaches, visit);
}

}  // namespace interflect::detail
