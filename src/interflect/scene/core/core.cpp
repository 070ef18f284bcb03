#include "interflect/scene/core/core.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Maximum distances from the middle, in reaches: for an origin of 0, and for faces of the core.
constexpr double near_in_reaches = 8, core_in_reaches = 64;

/// Returns the median of value(face), weighted by size.
template <class Value>
double weighted_median(std::span<const FaceExtent> faces, const Value& value) {
    struct Weighted {
        double value, weight;
    };
    std::vector<Weighted> order;
    order.reserve(faces.size());
    double sum = 0;
    for (const FaceExtent& face : faces) {
        order.push_back({value(face), face.size});
        sum += face.size;
    }
    std::sort(order.begin(), order.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    const double half = 0.5 * sum;
    double below = 0;
    for (const Weighted& w : order)
        if ((below += w.weight) >= half) return w.value;
    return order.back().value;
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
    constexpr std::size_t axes = 3;
    parallel_for_ranges(axes, 1, [&](std::size_t i, std::size_t) {
        const auto axis = static_cast<int>(i);
        core.middle[axis] = weighted_median(faces, [axis](const FaceExtent& face) { return face.centre[axis]; });
    });
    core.reach = weighted_median(
        faces, [&](const FaceExtent& face) { return (face.centre - core.middle).length() + 0.5 * face.size; });
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
    constexpr std::size_t patches_per_task = 4096;
    std::vector<Imath::Box3f> parts((scene.patches.size() + patches_per_task - 1) / patches_per_task);
    parallel_for_ranges(scene.patches.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        Imath::Box3f part;
        for (const Patch& patch : std::span(scene.patches).subspan(begin, end - begin)) {
            const Imath::Box3f box = box_of(scene, patch);
            if ((centre_of(box) - core.middle).length() <= core_in_reaches * core.reach) part.extendBy(box);
        }
        parts[begin / patches_per_task] = part;
    });
    Imath::Box3f bounds;
    for (const Imath::Box3f& part : parts) bounds.extendBy(part);
    return bounds;
}

}  // namespace interflect::detail
