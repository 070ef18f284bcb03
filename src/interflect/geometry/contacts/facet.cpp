#include "interflect/geometry/contacts/facet.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/search/bounds.h"
#include "interflect/scene/faces/patch_area.h"
#include "interflect/scene/faces/planarity.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Smallest feature relative to a face's diameter: 40 um on a face of 10 m.
constexpr double min_detail = 4e-6;

/// Rounding error relative to the largest coordinate: four roundings in single precision.
constexpr double relative_rounding = 0x1p-22;

}  // namespace

Facet::Facet(const Scene& scene, std::uint32_t face_index, std::span<const std::uint32_t> corner_vertices)
    : face(face_index), count(corner_vertices.size()) {
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        vertices[i] = corner_vertices[i];
        corners[i] = V3d(scene.vertices[vertices[i]]);
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(corners[i][c]));
        for (std::size_t j = 0; j < i; ++j) diameter = std::max(diameter, (corners[i] - corners[j]).length());
    }
    rounding = relative_rounding * largest;
    const V3d doubled = doubled_area_vector<double>({corners.data(), count});
    area_ = doubled.length() / 2;
    normal = doubled.normalized();
}

double Facet::detail() const { return std::max(min_detail * diameter, rounding); }

Imath::Box3f Facet::box(float margin) const {
    Imath::Box3f result;
    for (std::size_t i = 0; i < count; ++i) result.extendBy(V3f(corners[i]));
    return widened(result, margin);
}

std::vector<Facet> facets_of(const Scene& scene) {
    // Count the facets of each patch, then make them
    const std::size_t patches = scene.patches.size();
    std::vector<std::uint32_t> end(patches);
    parallel_for_indices(patches, [&](std::size_t i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side < i) return;
        end[i] = patch.is_triangle() || is_planar(scene, patch.vertices) ? 1 : 2;
    });
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Facet> facets(patches == 0 ? 0 : end.back());
    parallel_for_indices(patches, [&](std::size_t i) {
        const std::uint32_t begin = i == 0 ? 0 : end[i - 1], count = end[i] - begin;
        const auto face = static_cast<std::uint32_t>(i);
        const Patch& patch = scene.patches[i];
        const auto& v = patch.vertices;
        if (count == 1)
            facets[begin] = Facet(scene, face, std::span(v).first(static_cast<std::size_t>(patch.vertex_count())));
        if (count == 2) {  // Embree splits along the same diagonal
            facets[begin] = Facet(scene, face, std::array{v[0], v[1], v[3]});
            facets[begin + 1] = Facet(scene, face, std::array{v[2], v[3], v[1]});
        }
    });
    return facets;
}

PlaneFrame::PlaneFrame(const Facet& facet) : origin_(facet.corners[0]), normal_(facet.normal) {
    double longest = 0;
    for (std::size_t i = 0; i < facet.count; ++i) {
        const V3d edge = facet.corners[(i + 1) % facet.count] - facet.corners[i];
        if (edge.length() <= longest) continue;
        longest = edge.length();
        x_ = edge.normalized();
    }
    y_ = normal_.cross(x_).normalized();
}

}  // namespace interflect::detail
