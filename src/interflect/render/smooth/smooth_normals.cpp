#include "interflect/render/smooth/smooth_normals.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <cmath>

#include "interflect/geometry/surfaces/corner_normals.h"

namespace interflect::detail {

namespace {

/// Ridge of the fit of G, relative to the squared variation of the corner normals. It bounds G if neighbours are nearly
/// coplanar, and reduces G by 2% on a regular mesh.
constexpr double relative_ridge = 0.02;

/// Returns the mean irradiance of the leaves along edge c of an element.
Rgb mean_along_edge(const ElementForest& forest, std::span<const Rgb> irradiance, ElementIndex e, std::uint32_t c,
                    bool is_triangle) {
    if (forest.is_leaf(e)) return irradiance[e];
    // Edge c consists of the edges c of two children.
    constexpr std::array<std::uint32_t, 4> child_at_corner{0, 1, 3, 2};
    const std::uint32_t next = (c + 1) % (is_triangle ? 3 : 4);
    const auto half = [&](std::uint32_t corner) {
        const ElementIndex child = forest.first_child(e) + (is_triangle ? corner : child_at_corner[corner]);
        return mean_along_edge(forest, irradiance, child, c, is_triangle);
    };
    return 0.5f * (half(c) + half(next));
}

std::vector<ElementIndex> leaves_of(const ElementForest& forest, PatchIndex patch) {
    std::vector<ElementIndex> leaves, elements{patch};
    while (!elements.empty()) {
        const ElementIndex e = elements.back();
        elements.pop_back();
        if (forest.is_leaf(e)) {
            leaves.push_back(e);
            continue;
        }
        for (std::uint32_t k = 0; k < 4; ++k) elements.push_back(forest.first_child(e) + k);
    }
    return leaves;
}

}  // namespace

V3f SmoothNormals::CurvedPatch::normal_at(bool is_triangle, Parameters p) const {
    if (is_triangle) return normals[0] * (1 - p.u - p.v) + normals[1] * p.u + normals[2] * p.v;
    return (normals[0] * (1 - p.u) + normals[1] * p.u) * (1 - p.v) + (normals[3] * (1 - p.u) + normals[2] * p.u) * p.v;
}

V3f SmoothNormals::CurvedPatch::mean_normal(bool is_triangle) const {
    const V3f sum = normals[0] + normals[1] + normals[2];
    return is_triangle ? sum / 3 : (sum + normals[3]) / 4;
}

SmoothNormals::SmoothNormals(const Scene& scene, const SmoothSurfaces& surfaces) {
    if (scene.normals.empty()) return;
    const CornerNormals normals(scene, surfaces);
    const std::vector<V3f> own = patch_normals(scene);
    // Find the patch edges that form each shared edge
    std::vector<std::array<EdgeIndex, 2>> members(surfaces.edges.count);
    for (std::size_t i = 0; i < surfaces.edges.group.size(); ++i) {
        if (surfaces.edges.group[i] == none) continue;
        auto& [first, second] = members[surfaces.edges.group[i]];
        (first == none ? first : second) = EdgeIndex(i);
    }
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        CurvedPatch curved{.patch = p, .normals = {}};
        const auto count = static_cast<std::uint32_t>(scene.patches[p].vertex_count());
        bool is_curved = false, has_all = true;
        for (std::uint32_t c = 0; c < count; ++c) {
            curved.normals[c] = normals.at(CornerIndex(p, c));
            is_curved |= curved.normals[c].dot(own[p]) < cosine_of_flat;
            has_all &= curved.normals[c] != V3f(0);
        }
        if (!is_curved || !has_all) continue;
        curved.first_neighbour = static_cast<std::uint32_t>(neighbours_.size());
        for (std::uint32_t c = 0; c < count; ++c) {
            const EdgeIndex edge(p, c);
            const auto [first, second] = members[surfaces.edges.group[edge]];
            const EdgeIndex other = first == edge ? second : first;
            if (second != none) neighbours_.push_back({other.patch(), c, other.corner()});
        }
        curved.last_neighbour = static_cast<std::uint32_t>(neighbours_.size());
        curved_.push_back(curved);
    }
}

SmoothNormals::Gradient SmoothNormals::gradient(const ElementForest& forest, std::span<const Rgb> irradiance,
                                                const CurvedPatch& curved) const {
    const auto along = [&](PatchIndex patch, std::uint32_t edge) {
        return mean_along_edge(forest, irradiance, patch, edge, forest.geometry(patch).is_triangle());
    };
    // Fit G to the steps of irradiance across all edges, by least squares
    Imath::M33d squares(0, 0, 0, 0, 0, 0, 0, 0, 0);
    Gradient found{{Imath::V3d(0), Imath::V3d(0), Imath::V3d(0)}, Rgb(0)};
    for (const Neighbour& n : neighbours(curved)) {
        const Imath::V3d turn(forest.geometry(n.patch).normal() - forest.geometry(curved.patch).normal());
        const Rgb step = along(n.patch, n.other_edge) - along(curved.patch, n.edge);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) squares[i][j] += turn[i] * turn[j];
        for (int c = 0; c < 3; ++c) {
            found.by_normal[static_cast<std::size_t>(c)] += turn * static_cast<double>(step[c]);
            found.largest_change[c] = std::max(found.largest_change[c], std::abs(step[c]));
        }
    }
    const bool is_triangle = forest.geometry(curved.patch).is_triangle();
    double variation = 0;
    for (std::size_t c = 0; c < (is_triangle ? 3 : 4); ++c)
        variation += static_cast<double>((curved.normals[c] - curved.mean_normal(is_triangle)).length2());
    for (int i = 0; i < 3; ++i) squares[i][i] += relative_ridge * variation;
    const Imath::M33d inverse = squares.inverse();
    for (std::size_t c = 0; c < 3; ++c) found.by_normal[c] = found.by_normal[c] * inverse;
    return found;
}

void SmoothNormals::apply(const ElementForest& forest, std::vector<Rgb>& irradiance) const {
    // Gradients use the uncorrected irradiance of all neighbours
    std::vector<Gradient> gradients(curved_.size());
    constexpr std::size_t patches_per_task = 256;
    parallel_for_ranges(curved_.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) gradients[i] = gradient(forest, irradiance, curved_[i]);
    });
    parallel_for_ranges(curved_.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CurvedPatch& curved = curved_[i];
            const bool is_triangle = forest.geometry(curved.patch).is_triangle();
            const std::vector<ElementIndex> leaves = leaves_of(forest, curved.patch);
            const auto normal_of = [&](ElementIndex leaf) {
                return Imath::V3d(curved.normal_at(is_triangle, forest.cell(leaf).centre(is_triangle)));
            };
            Imath::V3d mean(0);
            for (const ElementIndex leaf : leaves) mean += normal_of(leaf) * static_cast<double>(forest.area(leaf));
            mean /= static_cast<double>(forest.area(curved.patch));
            for (const ElementIndex leaf : leaves) {
                const Imath::V3d turn = normal_of(leaf) - mean;
                for (int c = 0; c < 3; ++c) {
                    const auto change =
                        static_cast<float>(gradients[i].by_normal[static_cast<std::size_t>(c)].dot(turn));
                    const float most = gradients[i].largest_change[c];
                    irradiance[leaf][c] = std::max(0.0f, irradiance[leaf][c] + std::clamp(change, -most, most));
                }
            }
        }
    });
}

V3f SmoothNormals::at(const PatchGeometry& geometry, PatchIndex patch, Parameters p) const {
    const auto curved = std::lower_bound(curved_.begin(), curved_.end(), patch,
                                         [](const CurvedPatch& c, std::uint32_t x) { return c.patch < x; });
    if (curved == curved_.end() || curved->patch != patch) return geometry.normal();
    return curved->normal_at(geometry.is_triangle(), p).normalized();
}

}  // namespace interflect::detail
