#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/solution.h"

namespace interflect {

using namespace detail;

std::vector<Leaf> leaves(const Scene& scene, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    forest.require_made_for(scene);
    const bool has_importance = !solution.view_importance.empty();
    std::vector<Leaf> leaves;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!forest.is_leaf(e)) continue;
        Leaf leaf{.element = e, .patch = forest.patch(e), .area = forest.area(e), .irradiance = solution.irradiance[e]};
        const PatchGeometry& geometry = forest.geometry(leaf.patch);
        const Cell cell = forest.cell(e);
        for (ElementIndex ancestor = e; ancestor != leaf.patch; ancestor = forest.parent(ancestor)) ++leaf.level;
        const auto corner = [&](float u, float v) { return scene.origin + Imath::V3d(geometry.point(cell.at(u, v))); };
        if (geometry.is_triangle()) {
            leaf.vertex_count = 3;
            leaf.vertices = {corner(0, 0), corner(1, 0), corner(0, 1), corner(0, 1)};
        } else {
            leaf.vertices = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        }
        for (const std::vector<Rgb>& part : solution.direct) leaf.direct += part[e];
        if (has_importance) leaf.importance = solution.view_importance[e] + solution.indirect_importance[e];
        if (!solution.standard_error.empty()) leaf.standard_error = solution.standard_error[e];
        if (!solution.discretisation_error.empty()) leaf.discretisation_error = solution.discretisation_error[e];
        leaves.push_back(leaf);
    }
    return leaves;
}

}  // namespace interflect
