#pragma once

#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/smooth_field.h"

namespace interflect::testing_support {

/// Power received by all leaves, and by their interpolation (Gauss' rule of 2 x 2 points, the centre of triangles:
/// exact on each leaf). Red channel.
inline std::pair<double, double> powers(const detail::ElementForest& forest, const detail::ElementVertices& vertices,
                                        std::span<const Rgb> values) {
    constexpr float low = 0.5f - 0.5f * std::numbers::inv_sqrt3_v<float>, high = 1 - low;
    const detail::SmoothField field(forest, vertices, values);
    double power = 0, of_field = 0;
    for (const ElementIndex leaf : forest.leaves()) {
        const PatchIndex patch = forest.patch(leaf);
        const detail::PatchGeometry& geometry = forest.geometry(patch);
        const detail::Cell cell = forest.cell(leaf);
        const double area = forest.area(leaf);
        power += area * values[leaf].x;
        if (geometry.is_triangle()) {
            of_field += area * field.at(patch, cell.centre(true)).x;
            continue;
        }
        for (const float s : {low, high})
            for (const float t : {low, high}) {
                const detail::Parameters p = cell.at(s, t);
                of_field += 0.25 * cell.size * cell.size * geometry.jacobian(p) * field.at(patch, p).x;
            }
    }
    return {power, of_field};
}

}  // namespace interflect::testing_support
