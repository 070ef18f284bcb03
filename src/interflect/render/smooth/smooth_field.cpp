#include "interflect/render/smooth/smooth_field.h"

#include <fmt/format.h>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/vertex_values.h"

namespace interflect::detail {

SmoothField::SmoothField(const ElementForest& forest, const ElementVertices& vertices, std::span<const Rgb> values)
    : forest_(forest), vertices_(vertices) {
    if (values.size() != forest.size())
        throw InputError(
            fmt::format("{} values, expected one for each of the forest's {} elements", values.size(), forest.size()));
    value_ = vertex_values(forest, vertices, values);
}

Rgb SmoothField::at(PatchIndex patch, Parameters p) const {
    const ElementIndex leaf = forest_.leaf_at(patch, p);
    const Cell cell = forest_.cell(leaf);
    const float s = (p.u - cell.u) / cell.size, t = (p.v - cell.v) / cell.size;
    const auto& corners = vertices_.corners(leaf);
    const auto corner = [&](std::size_t c) { return value_[corners[c]]; };
    if (corners[3] == none) return corner(0) * (1 - s - t) + corner(1) * s + corner(2) * t;
    return (corner(0) * (1 - s) + corner(1) * s) * (1 - t) + (corner(3) * (1 - s) + corner(2) * s) * t;
}

}  // namespace interflect::detail
