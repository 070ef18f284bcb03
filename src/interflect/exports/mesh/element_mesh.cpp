#include "interflect/exports/mesh/element_mesh.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/render/smooth/vertex_values.h"

namespace interflect::detail {

namespace {

struct PositionHash {
    std::size_t operator()(const V3f& p) const {
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k) hash = mix(hash ^ std::hash<float>()(p[k]), 0);
        return hash;
    }
};

/// Returns the distance within which vertices are joined, the same as for smooth surfaces [m].
float joining_distance(const Scene& scene) {
    constexpr float relative = 0x1p-20f;
    float largest = 0;
    for (const Patch& patch : scene.patches)
        for (int c = 0; c < patch.vertex_count(); ++c)
            for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(scene.vertices[patch.vertices[c]][k]));
    return relative * largest;
}

Imath::Box3f box_around(const V3f& a, const V3f& b, float margin) {
    Imath::Box3f box(a);
    box.extendBy(b);
    box.min -= V3f(margin);
    box.max += V3f(margin);
    return box;
}

template <class Visit>
void visit_points_within(std::span<const Boxed> tree, const Imath::Box3f& box, const Visit& visit) {
    visit_box_tree(
        tree, [&](const Imath::Box3f& b) { return b.intersects(box); }, visit);
}

MeshCorner between(const MeshCorner& a, const MeshCorner& b, float t, std::uint32_t point) {
    return {point,
            {a.at.u + t * (b.at.u - a.at.u), a.at.v + t * (b.at.v - a.at.v)},
            a.irradiance * (1 - t) + b.irradiance * t};
}

}  // namespace

ElementMesh::ElementMesh(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance)
    : ElementMesh(scene, forest, ElementVertices(scene, forest), {}) {
    values_ = vertex_values(forest, vertices_, irradiance);
}

ElementMesh::ElementMesh(const Scene& scene, const ElementForest& forest, ElementVertices vertices,
                         std::vector<Rgb> irradiance)
    : forest_(forest),
      vertices_(std::move(vertices)),
      values_(std::move(irradiance)),
      corners_(forest.size(), {none, none, none, none}),
      tolerance_(joining_distance(scene)) {
    number_points();
    join_near_points();
}

void ElementMesh::number_points() {
    std::unordered_map<V3f, std::uint32_t, PositionHash> numbers;
    for (ElementIndex e{0}; e < forest_.size(); ++e) {
        if (!forest_.is_leaf(e)) continue;
        const PatchGeometry& geometry = forest_.geometry(forest_.patch(e));
        const Cell cell = forest_.cell(e);
        const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const auto [s, t] = corners[c];
            const V3f position = geometry.point(cell.at(s, t));
            const auto [entry, is_new] = numbers.try_emplace(position, static_cast<std::uint32_t>(points_.size()));
            if (is_new) points_.push_back(position);
            corners_[e][c] = entry->second;
        }
    }
}

void ElementMesh::join_near_points() {
    std::vector<Boxed> all(points_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = {Imath::Box3f(points_[i]), i};
    arrange_box_tree(all);
    std::vector<std::uint32_t> joined(points_.size());
    constexpr std::size_t points_per_task = 1 << 12;
    parallel_for_ranges(points_.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            joined[i] = static_cast<std::uint32_t>(i);
            visit_points_within(all, box_around(points_[i], points_[i], tolerance_), [&](std::uint32_t j) {
                if (j < joined[i] && (points_[j] - points_[i]).length() <= tolerance_) joined[i] = j;
            });
        }
    });
    for (std::uint32_t i = 0; i < joined.size(); ++i) {
        joined[i] = joined[joined[i]];  // smaller indices are already resolved
        if (joined[i] == i) tree_.push_back({Imath::Box3f(points_[i]), i});
    }
    arrange_box_tree(tree_);
    for (auto& corners : corners_)
        for (std::uint32_t& point : corners)
            if (point != none) point = joined[point];
}

void ElementMesh::add_points_on_edge(const MeshCorner& a, const MeshCorner& b, std::vector<MeshCorner>& outline) const {
    const V3f start = points_[a.point], edge = points_[b.point] - start;
    const float length = edge.length();
    if (!(length > 0)) return;
    const V3f direction = edge / length;
    const std::size_t first = outline.size();
    visit_points_within(tree_, box_around(start, start + edge, tolerance_), [&](std::uint32_t i) {
        if (i == a.point || i == b.point) return;
        const V3f offset = points_[i] - start;
        const float along = offset.dot(direction);
        if (along > tolerance_ && along < length - tolerance_ && (offset - along * direction).length() <= tolerance_)
            outline.push_back(between(a, b, along / length, i));
    });
    const auto distance2 = [&](const MeshCorner& c) { return (points_[c.point] - start).length2(); };
    std::sort(outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end(),
              [&](const MeshCorner& c, const MeshCorner& d) { return distance2(c) < distance2(d); });
}

std::vector<MeshCorner> ElementMesh::outline(ElementIndex leaf) const {
    const std::span<const Parameters> cell_corners = corners_of(forest_.geometry(forest_.patch(leaf)).is_triangle());
    const Cell cell = forest_.cell(leaf);
    const std::size_t count = cell_corners.size();
    std::array<MeshCorner, 4> corners;
    for (std::size_t c = 0; c < count; ++c) {
        const auto [s, t] = cell_corners[c];
        corners[c] = {corners_[leaf][c], cell.at(s, t), values_[vertices_.corners(leaf)[c]]};
    }
    std::vector<MeshCorner> outline;
    for (std::size_t c = 0; c < count; ++c) {
        const MeshCorner& next = corners[(c + 1) % count];
        if (corners[c].point == next.point) continue;  // the edge has no length
        outline.push_back(corners[c]);
        add_points_on_edge(corners[c], next, outline);
    }
    return outline;
}

void ElementMesh::triangulate(ElementIndex leaf, std::vector<MeshTriangle>& triangles) {
    const PatchGeometry& geometry = forest_.geometry(forest_.patch(leaf));
    const std::vector<MeshCorner> corners = outline(leaf);
    const std::size_t corner_count = geometry.is_triangle() ? 3 : 4;
    if (corners.size() < 3) return;
    if (corners.size() == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
    } else if (corners.size() == 4 && corner_count == 4) {
        const auto difference = [&](std::size_t a, std::size_t b) {
            return std::abs(channel_sum(corners[a].irradiance - corners[b].irradiance));
        };
        const std::size_t first = difference(0, 2) <= difference(1, 3) ? 0 : 1;
        const auto corner = [&](std::size_t c) { return corners[(first + c) % 4]; };
        triangles.push_back({corner(0), corner(1), corner(2)});
        triangles.push_back({corner(0), corner(2), corner(3)});
    } else {
        const Parameters middle = forest_.cell(leaf).centre(geometry.is_triangle());
        MeshCorner centre{static_cast<std::uint32_t>(points_.size()), middle};
        for (std::size_t c = 0; c < corner_count; ++c)
            centre.irradiance += values_[vertices_.corners(leaf)[c]] / static_cast<float>(corner_count);
        points_.push_back(geometry.point(middle));
        for (std::size_t c = 0; c < corners.size(); ++c)
            triangles.push_back({centre, corners[c], corners[(c + 1) % corners.size()]});
    }
}

}  // namespace interflect::detail
