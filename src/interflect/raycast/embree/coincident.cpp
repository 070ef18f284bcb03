#include "interflect/raycast/embree/coincident.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/coverage/covered_area.h"
#include "interflect/geometry/coverage/face_overlap.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/bounds.h"
#include "interflect/geometry/surfaces/flat_surfaces.h"

namespace interflect::detail {

namespace {

using V3d = Imath::V3d;

bool is_face(const Scene& scene, PatchIndex patch) { return scene.patches[patch].other_side >= patch; }

std::vector<V3f> corners(const Scene& scene, const Patch& patch) {
    std::vector<V3f> result;
    result.reserve(4);
    for (int i = 0; i < patch.vertex_count(); ++i)
        result.push_back(scene.vertices[patch.vertices[static_cast<std::size_t>(i)]]);
    return result;
}

/// Hashes the positions of the corners, independently of their order.
std::uint64_t corners_key(const Scene& scene, const Patch& patch) {
    std::uint64_t key = 0;
    for (int i = 0; i < patch.vertex_count(); ++i) {
        const V3f x = scene.vertices[patch.vertices[static_cast<std::size_t>(i)]] + V3f(0);  // replaces -0 by 0
        const auto bits = [](float f) { return std::uint64_t{std::bit_cast<std::uint32_t>(f)}; };
        key += mix(bits(x.x) << 32 | bits(x.y), bits(x.z));
    }
    return key;
}

bool have_same_corners(const Scene& scene, const Patch& p, const Patch& q) {
    const std::vector<V3f> a = corners(scene, p), b = corners(scene, q);
    return a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin());
}

/// @param p, q  Must have the same corners.
bool intercepts_all_rays_of(const Scene& scene, const Patch& p, const Patch& q) {
    if (p.other_side != none) return true;
    return q.other_side == none && PatchGeometry(scene, p).normal().dot(PatchGeometry(scene, q).normal()) > 0;
}

}  // namespace

CoincidentFaces::PriorityFace::PriorityFace(const Scene& scene, std::uint32_t face, float margin)
    : front(face), back(scene.patches[face].other_side) {
    const std::vector<V3f> vertices = corners(scene, scene.patches[face]);
    normal = PatchGeometry(scene, scene.patches[face]).normal();
    origin = vertices[0];
    for (std::size_t i = 0; i < inward.x.size(); ++i) {
        const std::size_t a = i % vertices.size(),
                          b = (i + 1) % vertices.size();  // a triangle's first edge is used twice
        const V3d along = V3d(vertices[b]) - V3d(vertices[a]);
        const V3d n = V3d(normal).cross(along).normalized();
        inward.x[i] = static_cast<float>(n.x);
        inward.y[i] = static_cast<float>(n.y);
        inward.z[i] = static_cast<float>(n.z);
        inward.offset[i] = static_cast<float>(n.dot(V3d(vertices[a]) - V3d(origin))) - margin;
    }
}

PatchIndex CoincidentFaces::PriorityFace::side_hit_by(const V3f& direction) const {
    return normal.dot(direction) > 0 ? back : front;
}

bool CoincidentFaces::PriorityFace::intercepts(const V3f& x, const V3f& direction) const {
    const V3f d = x - origin;
    std::size_t planes_passed = 0;
    for (std::size_t i = 0; i < inward.x.size(); ++i)
        planes_passed += inward.x[i] * d.x + inward.y[i] * d.y + inward.z[i] * d.z >= inward.offset[i];
    return planes_passed == inward.x.size() && side_hit_by(direction) != none;
}

CoincidentFaces::CoincidentFaces(const Scene& scene, std::span<const float> tolerance) : hidden_(scene.patches.size()) {
    const std::vector<std::uint32_t> rank = rank_by_flat_surface(scene);
    hide_duplicates(scene, rank);
    find_overlaps(scene, rank, tolerance);
    measure_uncovered(scene, tolerance);
}

/// Hides a face if a face of higher priority with the same corners intercepts all its rays. At most three remain: two
/// back to back, and a two-sided one.
void CoincidentFaces::hide_duplicates(const Scene& scene, std::span<const std::uint32_t> rank) {
    struct KeyedFace {
        std::uint64_t key;
        std::uint32_t rank, face;
    };
    std::vector<KeyedFace> faces;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (is_face(scene, i)) faces.push_back({0, rank[i], i});
    constexpr std::size_t faces_per_task = 4096;
    parallel_for_ranges(faces.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
        for (KeyedFace& face : std::span(faces).subspan(begin, end - begin))
            face.key = corners_key(scene, scene.patches[face.face]);
    });
    parallel_sort(faces, [](const KeyedFace& a, const KeyedFace& b) {
        return std::tie(a.key, a.rank) < std::tie(b.key, b.rank);
    });
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (i == 0 || faces[i].key != faces[i - 1].key) kept.clear();
        const Patch& patch = scene.patches[faces[i].face];
        const bool hidden = std::any_of(kept.begin(), kept.end(), [&](std::uint32_t other) {
            return have_same_corners(scene, scene.patches[other], patch) &&
                   intercepts_all_rays_of(scene, scene.patches[other], patch);
        });
        if (!hidden) kept.push_back(faces[i].face);
        hidden_[faces[i].face] = hidden;
        hidden_count_ += hidden;
    }
}

void CoincidentFaces::find_overlaps(const Scene& scene, std::span<const std::uint32_t> rank,
                                    std::span<const float> tolerance) {
    struct Overlap {
        std::uint32_t overlapped_face, priority_face;
    };
    // Collect the pairs, and the largest tolerance of each face
    std::vector<Overlap> pairs;
    std::vector<std::uint32_t> priority_ids;  // indices of faces
    for (const FacePair& p : overlapping_faces(scene, hidden_, tolerance)) {
        const auto [priority_face, overlapped_face] =
            std::minmax(p.larger, p.smaller, [&](auto a, auto b) { return rank[a] < rank[b]; });
        pairs.push_back({overlapped_face, priority_face});
        priority_ids.push_back(priority_face);
        const float distance = pair_tolerance(tolerance, p);
        tolerances_.push_back({p.larger, distance});
        tolerances_.push_back({p.smaller, distance});
    }
    if (pairs.empty()) return;
    std::sort(tolerances_.begin(), tolerances_.end(), [](const FaceTolerance& a, const FaceTolerance& b) {
        return std::tie(a.face, b.tolerance) < std::tie(b.face, a.tolerance);  // largest tolerance first
    });
    const auto same_face = [](const FaceTolerance& a, const FaceTolerance& b) { return a.face == b.face; };
    tolerances_.erase(std::unique(tolerances_.begin(), tolerances_.end(), same_face), tolerances_.end());
    const auto by_rank = [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; };
    std::sort(priority_ids.begin(), priority_ids.end(), by_rank);
    priority_ids.erase(std::unique(priority_ids.begin(), priority_ids.end()), priority_ids.end());
    for (const std::uint32_t face : priority_ids) priority_faces_.emplace_back(scene, face, tolerance[face]);

    // Build a box tree for each overlapped face
    std::sort(pairs.begin(), pairs.end(), [&](const Overlap& a, const Overlap& b) {
        return std::tie(a.overlapped_face, rank[a.priority_face]) < std::tie(b.overlapped_face, rank[b.priority_face]);
    });
    std::vector<std::uint32_t> overlapped;
    for (const auto [overlapped_face, priority_face] : pairs) {
        if (overlapped.empty() || overlapped.back() != overlapped_face) {
            if (!overlapped.empty()) overlap_begin_.push_back(overlaps_.size());
            overlapped.push_back(overlapped_face);
        }
        const float margin = 2 * std::max(tolerance[priority_face], tolerance[overlapped_face]);
        const Imath::Box3f box = widened(bounds_of(scene, scene.patches[priority_face]), margin);
        const auto index =
            std::lower_bound(priority_ids.begin(), priority_ids.end(), priority_face, by_rank) - priority_ids.begin();
        overlaps_.push_back({box, static_cast<std::uint32_t>(index)});
    }
    overlap_begin_.push_back(overlaps_.size());
    overlapped_ = RankedBits(scene.patches.size(), overlapped);
    for (std::size_t i = 0; i < overlapped.size(); ++i)
        arrange_box_tree(std::span(overlaps_).subspan(overlap_begin_[i], overlap_begin_[i + 1] - overlap_begin_[i]));
}

/// Computes the uncovered share of each side that a face of higher priority covers.
void CoincidentFaces::measure_uncovered(const Scene& scene, std::span<const float> tolerance) {
    struct Side {
        PatchIndex patch;
        float uncovered_share;
    };
    std::vector<Side> sides;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (hidden_[i] || overlapped_[i]) {
            sides.push_back({i, 0});
            if (scene.patches[i].other_side != none) sides.push_back({scene.patches[i].other_side, 0});
        }
    constexpr std::size_t sides_per_task = 16;
    parallel_for_ranges(sides.size(), sides_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> others;
        for (auto& [patch, uncovered_share] : std::span(sides).subspan(begin, end - begin)) {
            const std::uint32_t face = std::min(patch, scene.patches[patch].other_side);
            if (hidden_[face]) continue;
            const V3f incoming = -PatchGeometry(scene, scene.patches[patch]).normal();
            const std::size_t overlapped_index = overlapped_.rank(face);
            others.clear();
            for (std::size_t i = overlap_begin_[overlapped_index]; i < overlap_begin_[overlapped_index + 1]; ++i)
                if (const PriorityFace& priority_face = priority_faces_[overlaps_[i].index];
                    priority_face.side_hit_by(incoming) != none)
                    others.push_back(priority_face.front);
            uncovered_share = uncovered_area_share(scene, patch, others, tolerance[face]);
        }
    });
    std::erase_if(sides, [](const Side& side) { return !(side.uncovered_share < 1); });
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.patch < b.patch; });
    std::vector<std::uint32_t> patches;
    for (const auto& [patch, uncovered_share] : sides) {
        patches.push_back(patch);
        uncovered_share_.push_back(uncovered_share);
    }
    if (!patches.empty()) covered_ = RankedBits(scene.patches.size(), patches);
}

const CoincidentFaces::PriorityFace* CoincidentFaces::find_priority_face(std::uint32_t face, const V3f& x,
                                                                         const V3f& direction, float x_error) const {
    const std::size_t i = overlapped_.rank(face);
    const Imath::Box3f around_x(x - V3f(x_error), x + V3f(x_error));
    std::uint32_t best = none;
    visit_box_tree(
        std::span(overlaps_).subspan(overlap_begin_[i], overlap_begin_[i + 1] - overlap_begin_[i]),
        [&](const Imath::Box3f& box) { return box.intersects(around_x); },
        [&](std::uint32_t priority_index) {
            if (priority_index < best && priority_faces_[priority_index].intercepts(x, direction))
                best = priority_index;
        });
    return best == none ? nullptr : &priority_faces_[best];
}

PatchIndex CoincidentFaces::intercepting_patch(std::uint32_t face, const V3f& x, const V3f& direction,
                                               float x_error) const {
    PatchIndex patch{};
    // Coincidence within a tolerance is not transitive, so the intercepting face can be overlapped, too.
    while (overlapped_[face]) {
        const PriorityFace* priority_face = find_priority_face(face, x, direction, x_error);
        if (!priority_face) break;
        patch = priority_face->side_hit_by(direction);
        face = priority_face->front;
    }
    return patch;
}

std::size_t CoincidentFaces::memory() const {
    return hidden_.capacity() / 8 + overlapped_.memory() + priority_faces_.capacity() * sizeof(PriorityFace) +
           overlap_begin_.capacity() * sizeof(std::size_t) + overlaps_.capacity() * sizeof(Boxed) + covered_.memory() +
           uncovered_share_.capacity() * sizeof(float) + tolerances_.capacity() * sizeof(FaceTolerance);
}

}  // namespace interflect::detail
