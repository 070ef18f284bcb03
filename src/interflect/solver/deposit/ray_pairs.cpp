#include "interflect/solver/deposit/ray_pairs.h"

#include "interflect/elements/forest.h"

// The loops process unused lanes as well, which is faster than skipping them.
namespace interflect::detail {

void RayPairs::evaluate_oracle(const Oracle& oracle) {
    const float divisible_area = 4 * oracle.min_area;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Cell cell{u[i], v[i], size[i]};
        const V3f centre = PatchGeometry::Shape{patch_origin[i], edge_u[i], edge_v[i], twist[i]}.point(
            cell.centre(is_triangle[i] != 0));
        const ElementProxy from{shooter_centre[i], shooter_normal[i], shooter_area[i], shooter_least_cosine[i]};
        const ElementProxy to{centre, normal[i], area[i]};
        const bool is_small = (from.area < divisible_area) & (to.area < divisible_area);
        const bool accepted = oracle.accepts(from, to, reflected[i], importance[i]);
        settled[i] |= is_small | accepted;
    }
}

void RayPairs::choose_next(bool needs_leaf, std::uint32_t old_size) {
    const float *from_area = shooter_area.data(), *to_area = area.data();
    const std::uint32_t old = needs_leaf ? old_size : 0;  // importance is deposited on leaves of the old mesh
    for (std::size_t i = 0; i < lanes; ++i) {
        // Integers in place of bool give vector lanes of equal size.
        const std::uint32_t child = children[i], rejected = settled[i] ? 0 : 1;
        const std::uint32_t to_leaf = (receiver[i] < old ? 1 : 0) & (child < old ? 1 : 0);
        const std::uint32_t shooter_is_larger = from_area[i] > to_area[i] ? 1 : 0;
        const std::uint32_t lacks_children = rejected & ((child == none ? 1 : 0) | shooter_is_larger);
        const std::uint32_t descends = rejected ? 1 - lacks_children : to_leaf;
        needs_children[i] = lacks_children;
        continues[i] = rejected | to_leaf;
        next[i] = descends ? child : none;
    }
}

void RayPairs::descend() {
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool descends = next[i] != none, triangle = is_triangle[i] != 0;
        const Cell cell{u[i], v[i], size[i]};
        const unsigned k = cell.child_at({hit_u[i], hit_v[i]}, triangle);
        const Cell child = cell.child(k, triangle);
        receiver[i] = descends ? next[i] + k : receiver[i];
        power_receiver[i] = settled[i] ? power_receiver[i] : receiver[i];
        u[i] = descends ? child.u : cell.u;
        v[i] = descends ? child.v : cell.v;
        size[i] = descends ? child.size : cell.size;
    }
}

}  // namespace interflect::detail
