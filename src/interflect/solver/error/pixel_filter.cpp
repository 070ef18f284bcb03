#include "interflect/solver/error/pixel_filter.h"

#include <cmath>

#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Return the share of the variance of a piecewise constant signal that remains after a box filter of width 1; `a` is
/// the length of a piece. The pieces of shown_of_steps() are independent; shown_of_pairs() has pairs of pieces
/// with opposite values.
float shown_of_steps(float a) { return a > 1 ? 1 - 1 / (3 * a) : a * (1 - a / 3); }
float shown_of_pairs(float a) {
    if (a > 1) return 1 - 1 / (2 * a);
    if (a < 0.5f) return 2 * a * a / 3;
    const float beyond = 2 * a * (1 - a) - (1 + 2 * a) * (1 - a * a) / 2 + (1 - a * a * a) / 3;
    return a / 2 - beyond / a;
}

/// Extents of an element along the edges of its patch [pixel widths].
struct Extents {
    float u, v;
};
Extents extents_in_pixels(const RunInputs& inputs, const LightState& light, ElementIndex element) {
    const ElementForest& forest = *light.forest;
    const PatchGeometry::Shape& shape = forest.geometry(forest.patch(element)).shape();
    const float u2 = shape.edge_u.length2(), v2 = shape.edge_v.length2();
    const float area = shape.edge_u.cross(shape.edge_v).length();  // longer edge times the extent across it [m^2]
    const float aspect = !(area > 0) ? 1 : u2 > v2 ? u2 / area : area / v2;
    const float pixels = forest.area(element) / pixel_area(inputs, light, element);
    return {std::sqrt(pixels * aspect), std::sqrt(pixels / aspect)};
}

float shown_of_patch(const Extents& patch) { return shown_of_steps(patch.u) * shown_of_steps(patch.v); }
/// Averages over three cases: the differences of siblings change sign along u, along v, or along both.
float shown_of_siblings(const Extents& sibling) {
    const float u = shown_of_pairs(sibling.u), v = shown_of_pairs(sibling.v);
    return (u * shown_of_steps(2 * sibling.v) + shown_of_steps(2 * sibling.u) * v + u * v) / 3;
}

}  // namespace

float shown_of_patch(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, PatchIndex patch) {
    return measure == ErrorMeasure::surfaces ? 1 : shown_of_patch(extents_in_pixels(inputs, light, patch));
}

float shown_of_cluster(double pixels) {
    const float of_side = shown_of_steps(static_cast<float>(std::sqrt(pixels)));
    return of_side * of_side;
}

float shown_of_siblings(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex first) {
    return measure == ErrorMeasure::surfaces ? 1 : shown_of_siblings(extents_in_pixels(inputs, light, first));
}

std::array<float, finer_levels> shown_within(const RunInputs& inputs, const LightState& light, ErrorMeasure measure,
                                             ElementIndex leaf) {
    std::array<float, finer_levels> shares;
    shares.fill(1);
    if (measure == ErrorMeasure::surfaces) return shares;
    Extents extents = extents_in_pixels(inputs, light, leaf);
    for (float& of_level : shares) {
        extents.u /= 2;
        extents.v /= 2;
        of_level = (shown_of_pairs(extents.u) + shown_of_pairs(extents.v)) / 2;
    }
    return shares;
}

}  // namespace interflect::detail
