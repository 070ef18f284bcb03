#include "interflect/solver/deposit/ray_pairs.h"

#include "interflect/elements/forest.h"

// Processing unused lanes is faster than skipping them.
namespace interflect::detail {

void RayPairs::evaluate_oracle(const Oracle& oracle) {
    const float smallest = 4 * oracle.min_area;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Cell cell{u[i], v[i], size[i]};
        const V3f centre =
            PatchGeometry::Shape{origin[i], edge_u[i], edge_v[i], twist[i]}.point(cell.centre(is_triangle[i] != 0));
        const ElementProxy from{shooter_centre[i], shooter_normal[i], shooter_area[i], shooter_least_cosine[i]};
        const ElementProxy to{centre, normal[i], area[i]};
        const bool is_small = (from.area < smallest) & (to.area < smallest);
        const bool accepted = oracle.accepts(from, to, reflected[i], importance[i]);
        settled[i] |= is_small | accepted;
    }
}

void RayPairs::choose_next(bool needs_leaf, std::uint32_t old_size) {
    const float *from_area = shooter_area.data(), *to_area = area.data();
    const std::uint32_t old = needs_leaf ? old_size : 0;  // importance ignores newer elements
    for (std::size_t i = 0; i < lanes; ++i) {
        // Integers, not bool: all vectors have lanes of the same size.
        const std::uint32_t child = children[i], rejected = settled[i] ? 0 : 1;
        const std::uint32_t to_leaf = (receiver[i] < old ? 1 : 0) & (child < old ? 1 : 0);
        const std::uint32_t by_shooter = from_area[i] > to_area[i] ? 1 : 0;
        const std::uint32_t is_on_demand = rejected & ((child == none ? 1 : 0) | by_shooter);
        const std::uint32_t descends = rejected ? 1 - is_on_demand : to_leaf;
        on_demand[i] = is_on_demand;
        goes_on[i] = rejected | to_leaf;
        next[i] = descends ? child : none;
    }
}

void RayPairs::go_down() {
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool goes = next[i] != none, triangle = is_triangle[i] != 0;
        const Cell cell{u[i], v[i], size[i]};
        const unsigned k = cell.child_at({hit_u[i], hit_v[i]}, triangle);
        const Cell child = cell.child(k, triangle);
        receiver[i] = goes ? next[i] + k : receiver[i];
        of_power[i] = settled[i] ? of_power[i] : receiver[i];
        u[i] = goes ? child.u : cell.u;
        v[i] = goes ? child.v : cell.v;
        size[i] = goes ? child.size : cell.size;
    }
}

}  // namespace interflect::detail
