#include "interflect/geometry/search/wide_box_tree.h"

#include <algorithm>
#include <limits>
#include <span>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

constexpr std::size_t worth_a_task = 1 << 12, nodes_per_task = 512;

/// Sorts the elements into compact groups by medians. The groups have width^k elements, for each k, except the last
/// ones.
void arrange(std::span<Boxed> elements, std::size_t width) {
    if (elements.size() <= width) return;
    std::size_t group = width;
    while (group * width < elements.size()) group *= width;
    const std::size_t middle = (elements.size() + group - 1) / group / 2 * group;
    Imath::Box3f doubled_centres;
    for (const Boxed& e : elements) doubled_centres.extendBy(e.box.min + e.box.max);
    const auto axis = static_cast<int>(doubled_centres.majorAxis());
    std::nth_element(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(middle), elements.end(),
                     [axis](const Boxed& a, const Boxed& b) {
                         return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
                     });
    const auto arrange_first = [&] { arrange(elements.first(middle), width); };
    const auto arrange_second = [&] { arrange(elements.subspan(middle), width); };
    if (elements.size() >= worth_a_task) {
        parallel_invoke(arrange_first, arrange_second);
    } else {
        arrange_first();
        arrange_second();
    }
}

}  // namespace

WideBoxTree::Node::Node() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        min[axis].fill(std::numeric_limits<float>::infinity());
        max[axis].fill(-std::numeric_limits<float>::infinity());
    }
}

void WideBoxTree::Node::set(std::size_t child, const Imath::Box3f& box) {
    for (int axis = 0; axis < 3; ++axis) {
        min[static_cast<std::size_t>(axis)][child] = box.min[axis];
        max[static_cast<std::size_t>(axis)][child] = box.max[axis];
    }
}

Imath::Box3f WideBoxTree::Node::bounds() const {
    Imath::Box3f bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.min[static_cast<int>(axis)] = *std::min_element(min[axis].begin(), min[axis].end());
        bounds.max[static_cast<int>(axis)] = *std::max_element(max[axis].begin(), max[axis].end());
    }
    return bounds;
}

WideBoxTree::WideBoxTree(std::vector<Boxed> elements) : indices_(elements.size()) {
    if (elements.empty()) return;
    arrange(elements, width);
    const auto add_level = [&](std::size_t children, const auto& box_of_child) {
        std::vector<Node> nodes((children + width - 1) / width);
        parallel_for_ranges(nodes.size(), nodes_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t child = begin * width; child < std::min(children, end * width); ++child)
                nodes[child / width].set(child % width, box_of_child(child));
        });
        levels_.push_back(std::move(nodes));
    };
    add_level(elements.size(), [&](std::size_t i) {
        indices_[i] = elements[i].index;
        return elements[i].box;
    });
    while (levels_.back().size() > 1) {
        const std::vector<Node>& below = levels_.back();
        add_level(below.size(), [&](std::size_t i) { return below[i].bounds(); });
    }
}

}  // namespace interflect::detail
