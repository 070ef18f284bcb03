#pragma once

#include <ImathBox.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/geometry/search/box_tree.h"

namespace interflect::detail {

/// Bounding volume hierarchy whose nodes have eight children and test their boxes together. Unlike a box tree, it tests
/// each element's own box.
class WideBoxTree {
  public:
    explicit WideBoxTree(std::vector<Boxed> elements);

    /// Calls visit(index) for each element whose box intersects `box`, if reaches(b) is true for the element's box b
    /// and for the boxes of all nodes above it.
    template <class Reaches, class Visit>
    void search(const Imath::Box3f& box, const Reaches& reaches, const Visit& visit) const {
        if (!levels_.empty()) search_node(levels_.size() - 1, 0, box, reaches, visit);
    }

  private:
    static constexpr std::size_t width = 8;

    /// Boxes of the children, one array per coordinate; missing children have empty boxes.
    struct Node {
        std::array<std::array<float, width>, 3> min, max;

        Node();
        void set(std::size_t child, const Imath::Box3f& box);
        Imath::Box3f box(std::size_t child) const {
            return {{min[0][child], min[1][child], min[2][child]}, {max[0][child], max[1][child], max[2][child]}};
        }
        Imath::Box3f bounds() const;

        /// Returns a bit for each child whose box intersects `b`. Operators without branches allow vectorisation.
        std::uint32_t intersecting(const Imath::Box3f& b) const {
            std::uint32_t children = 0;
            for (std::uint32_t i = 0; i < width; ++i) {
                std::uint32_t intersects = 1;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const auto c = static_cast<int>(axis);
                    intersects &= std::uint32_t{min[axis][i] <= b.max[c]} & std::uint32_t{max[axis][i] >= b.min[c]};
                }
                children |= intersects << i;
            }
            return children;
        }
    };

    template <class Reaches, class Visit>
    void search_node(std::size_t level, std::size_t index, const Imath::Box3f& box, const Reaches& reaches,
                     const Visit& visit) const {
        const Node& node = levels_[level][index];
        for (std::uint32_t children = node.intersecting(box); children != 0; children &= children - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(children));
            if (!reaches(node.box(child))) continue;
            if (level == 0)
                visit(indices_[index * width + child]);
            else
                search_node(level - 1, index * width + child, box, reaches, visit);
        }
    }

    std::vector<std::uint32_t> indices_;     // of the elements, in groups of `width` that share a node
    std::vector<std::vector<Node>> levels_;  // from the elements' nodes to the root; child c of node n is n * width + c
};

}  // namespace interflect::detail
