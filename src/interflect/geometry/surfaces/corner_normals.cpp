#include "interflect/geometry/surfaces/corner_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "interflect/geometry/search/disjoint_sets.h"

namespace interflect::detail {

namespace {

constexpr float flat_deviation = 0.0087f;  // length by which a unit vector changes at the angle of cosine_of_flat

/// Returns the pairs of patches that are joined by smooth edges.
std::vector<std::array<PatchIndex, 2>> smooth_neighbours(const SmoothSurfaces& surfaces) {
    std::vector<std::array<PatchIndex, 2>> pairs;
    std::vector<PatchIndex> first(surfaces.edges.count);
    for (std::size_t i = 0; i < surfaces.edges.group.size(); ++i) {
        const std::uint32_t group = surfaces.edges.group[i];
        const PatchIndex patch = EdgeIndex(i).patch();
        if (group == none) continue;
        if (first[group] == no_patch)
            first[group] = patch;
        else
            pairs.push_back({first[group], patch});
    }
    for (const SmoothSurfaces::Seam& seam : surfaces.seams)
        pairs.push_back({seam.edge[0].patch(), seam.edge[1].patch()});
    return pairs;
}

/// Differences between the normal of each flat part of a surface and the normals of its smooth neighbours.
class Bends {
  public:
    Bends(const Scene& scene, std::span<const V3f> face_normals, const SmoothSurfaces& surfaces)
        : parts_(face_normals.size()) {
        const auto neighbours = smooth_neighbours(surfaces);
        for (const auto& [a, b] : neighbours)
            if (face_normals[a].dot(face_normals[b]) >= cosine_of_flat) parts_.unite(a, b);
        unite_pieces(scene);
        for (const auto& [a, b] : neighbours) {
            const std::uint32_t p = parts_.find(a), q = parts_.find(b);
            if (p == q) continue;
            bends_.push_back({p, q, face_normals[b] - face_normals[a]});
            bends_.push_back({q, p, face_normals[a] - face_normals[b]});
        }
        const auto key = [](const Bend& b) { return std::pair(b.part, b.neighbour); };
        std::stable_sort(bends_.begin(), bends_.end(), [&](const Bend& a, const Bend& b) { return key(a) < key(b); });
        bends_.erase(
            std::unique(bends_.begin(), bends_.end(), [&](const Bend& a, const Bend& b) { return key(a) == key(b); }),
            bends_.end());
    }

    /// Returns the largest scalar product of `direction` and a bend of the patch; at least 0.
    float largest_along(PatchIndex patch, const V3f& direction) {
        const auto [first, last] = std::equal_range(bends_.begin(), bends_.end(), Bend{parts_.find(patch), 0, V3f(0)},
                                                    [](const Bend& a, const Bend& b) { return a.part < b.part; });
        float largest = 0;
        for (auto bend = first; bend != last; ++bend) largest = std::max(largest, std::abs(bend->turn.dot(direction)));
        return largest;
    }

  private:
    struct Bend {
        std::uint32_t part, neighbour;
        V3f turn;
    };

    /// Unites the pieces of a face, between which contacts are borders.
    void unite_pieces(const Scene& scene) {
        std::map<std::pair<std::uint32_t, bool>, std::uint32_t> first;
        for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
            const Patch& patch = scene.patches[p];
            if (patch.surface == none) continue;
            const bool is_back = patch.other_side < p;
            parts_.unite(first.try_emplace({patch.surface, is_back}, p).first->second, p);
        }
    }

    DisjointSets parts_;
    std::vector<Bend> bends_;
};

/// Returns the angle of a patch at its corner [rad].
float corner_angle(const Scene& scene, const Patch& patch, int c) {
    const int count = patch.vertex_count();
    const auto position = [&](int corner) {
        return scene.vertices[patch.vertices[static_cast<std::size_t>(corner % count)]];
    };
    const V3f a = position(c + 1) - position(c), b = position(c + count - 1) - position(c);
    return std::atan2(a.cross(b).length(), a.dot(b));
}

}  // namespace

CornerNormals::CornerNormals(const Scene& scene, const SmoothSurfaces& surfaces)
    : normals_(4 * scene.patches.size(), V3f(0)), is_replaced_(normals_.size(), false) {
    if (scene.normals.empty()) return;
    const std::vector<V3f> face_normals = patch_normals(scene);
    const auto for_each_corner = [&](const auto& body) {
        for (PatchIndex p{0}; p < scene.patches.size(); ++p)
            for (int c = 0; c < scene.patches[p].vertex_count(); ++c) {
                const CornerIndex corner(p, static_cast<std::uint32_t>(c));
                body(corner, surfaces.corners.group[corner]);
            }
    };
    // Average both kinds of normals over each group of joined corners
    std::vector<V3f> mean(surfaces.corners.count, V3f(0)), authored = mean;
    for_each_corner([&](CornerIndex corner, std::uint32_t group) {
        const Patch& patch = scene.patches[corner.patch()];
        const V3f n = scene.normals[patch.vertices[corner.corner()]];
        normals_[corner] = n.dot(face_normals[corner.patch()]) < 0 ? -n : n;
        authored[group] += normals_[corner];
        mean[group] += face_normals[corner.patch()] * corner_angle(scene, patch, static_cast<int>(corner.corner()));
    });
    for (V3f& n : mean) n.normalize();
    for (V3f& n : authored) n.normalize();

    // Accept the file's normals in groups where the deviation is small, and replace them in the others
    Bends bends(scene, face_normals, surfaces);
    std::vector<bool> is_accepted(mean.size(), false);
    for_each_corner([&](CornerIndex corner, std::uint32_t group) {
        if (is_accepted[group]) return;
        const V3f deviation = authored[group] - mean[group];
        is_accepted[group] = deviation.length() <= flat_deviation ||
                             deviation.length2() <= bends.largest_along(corner.patch(), deviation);
    });
    for_each_corner([&](CornerIndex corner, std::uint32_t group) {
        if (is_accepted[group] || normals_[corner] == V3f(0)) return;
        normals_[corner] = mean[group];
        is_replaced_[corner] = true;
    });
}

std::vector<PatchIndex> CornerNormals::contradicted_patches(const Scene& scene, float degrees) const {
    const float cosine = std::cos(degrees * std::numbers::pi_v<float> / 180);
    std::vector<PatchIndex> patches;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const Patch& patch = scene.patches[p];
        if (patch.other_side < p) continue;
        const V3f face_normal = PatchGeometry(scene, patch).normal();
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(patch.vertex_count()); ++c)
            if (is_replaced_[CornerIndex(p, c)] &&
                std::abs(scene.normals[patch.vertices[c]].dot(face_normal)) < cosine) {
                patches.push_back(p);
                break;
            }
    }
    return patches;
}

}  // namespace interflect::detail
