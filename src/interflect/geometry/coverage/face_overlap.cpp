#include "interflect/geometry/coverage/face_overlap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/geometry/search/bounds.h"
#include "interflect/geometry/search/wide_box_tree.h"
#include "interflect/scene/faces/patch_area.h"

namespace interflect::detail {

namespace {

using V3d = Imath::V3d;

/// Minimum cosine between the normals of overlapping faces. It rejects low upright faces, but tolerates the noisy
/// normals of small faces.
constexpr double min_facing = 0.7;

constexpr std::size_t search_grain = 1024;

/// A face of up to four corners, to which clipping by another one adds up to four.
struct ClippedFace {
    std::array<V3d, 8> corners;
    std::size_t count = 0;

    void add(const V3d& corner) { corners[count++] = corner; }
    std::span<const V3d> face_corners() const { return {corners.data(), count}; }
};

ClippedFace polygon_of(const Scene& scene, const Patch& patch) {
    ClippedFace polygon;
    for (int i = 0; i < patch.vertex_count(); ++i)
        polygon.add(V3d(scene.vertices[patch.vertices[static_cast<std::size_t>(i)]]));
    return polygon;
}

/// Half space of the points x with normal . x >= offset; the normal has unit length.
struct HalfSpace {
    V3d normal;
    double offset = 0;

    double height(const V3d& x) const { return normal.dot(x) - offset; }
};

bool lies_outside(const ClippedFace& polygon, const HalfSpace& half_space) {
    return std::none_of(polygon.corners.begin(), polygon.corners.begin() + static_cast<std::ptrdiff_t>(polygon.count),
                        [&](const V3d& corner) { return half_space.height(corner) >= 0; });
}

ClippedFace clipped(const ClippedFace& polygon, const HalfSpace& half_space) {
    ClippedFace result;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const V3d &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const double height_a = half_space.height(a), height_b = half_space.height(b);
        if (height_a >= 0) result.add(a);
        if ((height_a >= 0) != (height_b >= 0)) result.add(a + (b - a) * (height_a / (height_a - height_b)));
    }
    return result;
}

/// Normal of a face times twice its area, and twice its area [m^2].
struct FaceArea {
    V3d doubled_vector{0};
    double doubled = 0;
};

/// Plane through the mean of a face's corners.
HalfSpace plane_of(const ClippedFace& polygon, const FaceArea& area) {
    HalfSpace plane{area.doubled_vector / area.doubled};
    for (std::size_t i = 0; i < polygon.count; ++i)
        plane.offset += plane.normal.dot(polygon.corners[i]) / static_cast<double>(polygon.count);
    return plane;
}

/// Tests which smaller faces overlap one face.
class LargerFace {
  public:
    LargerFace(const Scene& scene, std::uint32_t face, std::span<const FaceArea> areas,
               std::span<const float> tolerance)
        : scene_(scene),
          face_(face),
          areas_(areas),
          tolerance_(tolerance),
          polygon_(polygon_of(scene, scene.patches[face])),
          plane_(plane_of(polygon_, areas[face])) {}

    bool plane_meets(const Imath::Box3f& box) const {
        return meets_plane(
            box, plane_.normal, [&](const V3d& x) { return plane_.height(x); }, static_cast<double>(tolerance_[face_]));
    }

    bool is_overlapped_by(std::uint32_t face) {
        const FaceArea& area = areas_[face];
        if (face == face_ || !is_smaller(face, area.doubled)) return false;
        const double facing = area.doubled_vector.dot(plane_.normal);
        if (std::abs(facing) < min_facing * area.doubled) return false;  // true for most neighbours
        if (facing < 0 && is_one_sided(face_) && is_one_sided(face)) return false;
        find_inside();
        ClippedFace shared = polygon_of(scene_, scene_.patches[face]);
        const double tolerance = pair_tolerance(tolerance_, {face_, face});
        const auto narrowed = [&](HalfSpace half_space) {
            half_space.offset += tolerance;
            return half_space;
        };
        for (std::size_t i = 0; i < polygon_.count; ++i)
            if (lies_outside(shared, narrowed(inside_[i]))) return false;
        for (std::size_t i = 0; i < polygon_.count && shared.count > 0; ++i)
            shared = clipped(shared, narrowed(inside_[i]));
        const auto end = shared.corners.begin() + static_cast<std::ptrdiff_t>(shared.count);
        return shared.count > 0 && std::all_of(shared.corners.begin(), end,
                                               [&](const V3d& x) { return std::abs(plane_.height(x)) <= tolerance; });
    }

  private:
    bool is_one_sided(std::uint32_t face) const { return scene_.patches[face].other_side == none; }
    bool is_smaller(std::uint32_t face, double doubled_area) const {
        return doubled_area < areas_[face_].doubled || (doubled_area == areas_[face_].doubled && face < face_);
    }

    void find_inside() {
        if (has_inside_) return;
        has_inside_ = true;
        for (std::size_t i = 0; i < polygon_.count; ++i) {
            const V3d &a = polygon_.corners[i], &b = polygon_.corners[(i + 1) % polygon_.count];
            const V3d inward = plane_.normal.cross(b - a).normalized();
            inside_[i] = {inward, inward.dot(a)};
        }
    }

    const Scene& scene_;
    std::uint32_t face_;
    std::span<const FaceArea> areas_;
    std::span<const float> tolerance_;
    ClippedFace polygon_;
    HalfSpace plane_;
    std::array<HalfSpace, 4> inside_;  // of the edges, once a face needs them
    bool has_inside_ = false;
};

bool is_searched(const Scene& scene, const std::vector<bool>& ignored, PatchIndex i) {
    return scene.patches[i].other_side >= i && !ignored[i];
}

std::vector<FaceArea> areas_of_faces(const Scene& scene) {
    std::vector<FaceArea> areas(scene.patches.size());
    parallel_for_ranges(areas.size(), search_grain, [&](std::size_t begin, std::size_t end) {
        for (PatchIndex i(begin); i < end; ++i) {
            if (scene.patches[i].other_side < i) continue;
            const ClippedFace polygon = polygon_of(scene, scene.patches[i]);
            const V3d doubled = doubled_area_vector<double>(polygon.face_corners());
            areas[i] = {doubled, doubled.length()};
        }
    });
    return areas;
}

WideBoxTree tree_of_faces(const Scene& scene, const std::vector<bool>& ignored, std::span<const float> tolerance) {
    std::vector<Boxed> faces;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (is_searched(scene, ignored, i)) faces.push_back({Imath::Box3f(), i});
    parallel_for_ranges(faces.size(), search_grain, [&](std::size_t begin, std::size_t end) {
        for (Boxed& face : std::span(faces).subspan(begin, end - begin))
            face.box = widened(bounds_of(scene, scene.patches[face.index]), tolerance[face.index]);
    });
    return WideBoxTree(std::move(faces));
}

}  // namespace

std::vector<FacePair> overlapping_faces(const Scene& scene, const std::vector<bool>& ignored,
                                        std::span<const float> tolerance) {
    const WideBoxTree tree = tree_of_faces(scene, ignored, tolerance);
    const std::vector<FaceArea> areas = areas_of_faces(scene);
    const std::size_t most = free_overlaps + max_overlaps_per_patch * scene.patches.size();
    std::atomic<std::size_t> count = 0;
    std::vector<std::vector<FacePair>> found((scene.patches.size() + search_grain - 1) / search_grain);
    parallel_for_ranges(scene.patches.size(), search_grain, [&](std::size_t begin, std::size_t end) {
        for (PatchIndex i(begin); i < end; ++i) {
            if (!is_searched(scene, ignored, i) || count > most) continue;
            LargerFace larger(scene, i, areas, tolerance);
            tree.search(
                widened(bounds_of(scene, scene.patches[i]), tolerance[i]),
                [&](const Imath::Box3f& b) { return larger.plane_meets(b); },
                [&](std::uint32_t j) {
                    if (count > most || !larger.is_overlapped_by(j)) return;
                    found[begin / search_grain].push_back({i, j});
                    ++count;
                });
        }
    });
    if (count > most)
        throw InputError(scene.name, 0,
                         fmt::format("more than {} pairs of its faces lie in each other: expected surfaces of one "
                                     "layer; remove copies of faces",
                                     most));
    std::vector<FacePair> pairs;
    for (const std::vector<FacePair>& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
    return pairs;
}

}  // namespace interflect::detail
