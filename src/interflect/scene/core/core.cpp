#include "interflect/scene/core/core.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Maximum distances from the middle, in reaches: for an origin of 0, and for faces of the core.
constexpr double near_in_reaches = 8, core_in_reaches = 64;

double weighted_median(std::span<const double> values, std::span<const double> weights) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    const double half = 0.5 * std::accumulate(weights.begin(), weights.end(), 0.0);
    double below = 0;
    for (const std::size_t i : order)
        if ((below += weights[i]) >= half) return values[i];
    return values[order.back()];
}

Imath::Box3f box_of(const Scene& scene, const Patch& patch) {
    Imath::Box3f box;
    for (int k = 0; k < patch.vertex_count(); ++k)
        box.extendBy(scene.vertices[patch.vertices[static_cast<std::size_t>(k)]]);
    return box;
}

V3d centre_of(const Imath::Box3f& box) { return (V3d(box.min) + V3d(box.max)) * 0.5; }

}  // namespace

void FaceSample::add(const FaceExtent& face) {
    faces_.push_back(face);
    if (faces_.size() < capacity) return;
    for (std::size_t i = 0; 2 * i < faces_.size(); ++i) faces_[i] = faces_[2 * i];
    faces_.resize(faces_.size() / 2);
    stride_ *= 2;
}

Core core_of(std::span<const FaceExtent> faces) {
    Core core;
    if (faces.empty()) return core;
    std::vector<double> weights, values(faces.size());
    weights.reserve(faces.size());
    for (const FaceExtent& face : faces) weights.push_back(face.size);
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(faces.begin(), faces.end(), values.begin(),
                       [axis](const FaceExtent& face) { return face.centre[axis]; });
        core.middle[axis] = weighted_median(values, weights);
    }
    std::transform(faces.begin(), faces.end(), values.begin(),
                   [&](const FaceExtent& face) { return (face.centre - core.middle).length() + 0.5 * face.size; });
    core.reach = weighted_median(values, weights);
    return core;
}

V3d origin_for(const Core& core) {
    const V3d& m = core.middle;
    if (std::max({std::abs(m.x), std::abs(m.y), std::abs(m.z)}) <= near_in_reaches * core.reach) return V3d(0);
    const double step = std::exp2(std::ceil(std::log2(core.reach)));
    const auto rounded = [step](double coordinate) {
        return std::round(coordinate / step) * step + 0.0;
    };  // turns -0 into 0
    return {rounded(m.x), rounded(m.y), rounded(m.z)};
}

Imath::Box3f core_bounds(const Scene& scene) {
    FaceSample sample;
    for (const Patch& patch : scene.patches) {
        if (!sample.wants_next()) continue;
        const Imath::Box3f box = box_of(scene, patch);
        sample.add({centre_of(box), static_cast<double>(box.size().length())});
    }
    const Core core = core_of(sample.faces());
    Imath::Box3f bounds;
    for (const Patch& patch : scene.patches) {
        const Imath::Box3f box = box_of(scene, patch);
        if ((centre_of(box) - core.middle).length() <= core_in_reaches * core.reach) bounds.extendBy(box);
    }
    return bounds;
}

}  // namespace interflect::detail
