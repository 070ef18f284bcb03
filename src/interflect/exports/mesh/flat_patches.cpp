#include "interflect/exports/mesh/flat_patches.h"

#include <algorithm>
#include <limits>

namespace interflect::detail {

Imath::V2d FlatPatch::point(Parameters p) const {
    const double u = p.u, v = p.v;
    if (count == 3) return corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
    return (corners[0] * (1 - u) + corners[1] * u) * (1 - v) + (corners[3] * (1 - u) + corners[2] * u) * v;
}

double FlatPatch::signed_area() const {
    double doubled = 0;
    for (std::size_t c = 2; c < outline().size(); ++c)
        doubled += (corners[c - 1] - corners[0]).cross(corners[c] - corners[0]);
    return doubled / 2;
}

Imath::Box2d FlatPatch::box() const {
    Imath::Box2d all;
    for (const Imath::V2d& corner : outline()) all.extendBy(corner);
    return all;
}

FlatPatches projected(const Scene& scene, std::span<const PatchIndex> patches) {
    const Patch& first = scene.patches[patches.front()];
    const Imath::V3d origin(scene.vertices[first.vertices[0]]);
    const Imath::V3d normal(PatchGeometry(scene, first).normal());
    const Imath::V3d edge = Imath::V3d(scene.vertices[first.vertices[1]]) - origin;
    const Imath::V3d x = (edge - normal * edge.dot(normal)).normalized(), y = normal.cross(x);
    FlatPatches flat;
    for (const PatchIndex p : patches) {
        const Patch& patch = scene.patches[p];
        flat.push_back({p, patch.vertex_count()});
        for (int c = 0; c < patch.vertex_count(); ++c) {
            const Imath::V3d offset = Imath::V3d(scene.vertices[patch.vertices[c]]) - origin;
            flat.back().corners[static_cast<std::size_t>(c)] = {offset.dot(x), offset.dot(y)};
        }
    }
    return flat;
}

double separation(const FlatPatch& a, const FlatPatch& b) {
    // Separating axes: the outward normals of all edges.
    double largest = std::numeric_limits<double>::lowest();
    const auto try_edges = [&](const FlatPatch& owner, const FlatPatch& other) {
        const double orientation = owner.signed_area() < 0 ? -1 : 1;
        for (std::size_t c = 0; c < owner.outline().size(); ++c) {
            const Imath::V2d start = owner.corners[c], edge = owner.corners[(c + 1) % owner.outline().size()] - start;
            if (!(edge.length() > 0)) continue;
            const Imath::V2d outwards = Imath::V2d(edge.y, -edge.x) * (orientation / edge.length());
            double nearest = std::numeric_limits<double>::max();
            for (const Imath::V2d& corner : other.outline()) nearest = std::min(nearest, outwards.dot(corner - start));
            largest = std::max(largest, nearest);
        }
    };
    try_edges(a, b);
    try_edges(b, a);
    return largest;
}

}  // namespace interflect::detail
