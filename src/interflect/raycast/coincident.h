#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/ranked_bits.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Faces that lie in one place, as a sheet of paper in the plane of its desk or two boxes with a common side, and which
/// of them answers a ray there. A ray tracer takes the one that it happens to test first: light could arrive at one
/// and camera rays at the other. Here the same one always answers, whatever the ray: that of the smaller surface (paper
/// on a desk; see flat_surfaces.h for what is one surface), of (nearly) equal surfaces the one that emits, since a lamp
/// in the place of a ceiling tile is meant to be seen, then the one that comes first in the scene. A one-sided face
/// answers, and takes part at all, only where it is seen from its front.
///
/// Two faces coincide where they overlap in (nearly) one plane: where one's polygon reaches more than pair_tolerance()
/// (face_overlap.h) into the other's, and all of what they share lies within it of the larger one's plane; or where
/// they have the same corners. Faces that share an edge only do not.
///
/// What never answers a ray must send none: uncovered_share() tells how much of a patch does.
///
/// A face is named by its patch, of a two-sided one by the first. Memory: a bit a patch where nothing coincides, else
/// 5, and 96 bytes more for each face that has priority over another, 28 for each pair.
class CoincidentFaces {
  public:
    /// Finds all that coincide: O(n log n) for n patches of which each overlaps a bounded number of others.
    /// @param scene      Valid (scene_faults); convex quadrilaterals.
    /// @param tolerance  Of each face [m], > 0: what its coordinates may be off by. Size scene.patches.size().
    CoincidentFaces(const Scene& scene, std::span<const float> tolerance);
    /// With the same tolerance for all faces.
    CoincidentFaces(const Scene& scene, float tolerance)
        : CoincidentFaces(scene, std::vector<float>(scene.patches.size(), tolerance)) {}

    /// Whether the face has the corners of another that answers wherever it could: it may be left out.
    bool is_hidden(std::uint32_t face) const { return hidden_[face]; }

    /// Whether a face of higher priority overlaps it in part, so that a ray that meets it must ask for answering_patch.
    bool is_overlapped(std::uint32_t face) const { return overlapped_[face]; }

    /// Which patch answers a ray whose first hit is the overlapped `face` at x: of the face that has priority there,
    /// the side that the ray sees; none where `face` itself answers. O(log k) time for k faces that overlap it.
    /// @param x_error  How far x may lie off the face [m].
    std::uint32_t answering_patch(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    /// The share of a patch's area, in [0, 1], where it answers the rays that come from its side: 0 for a patch that is
    /// hidden or covered wholly, by whatever number of others, 1 where nothing coincides. Slivers as wide as the
    /// tolerance count as covered.
    float uncovered_share(std::uint32_t patch) const {
        return covered_[patch] ? uncovered_share_[covered_.rank(patch)] : 1.0f;
    }

    bool has_covered_patches() const { return !uncovered_share_.empty(); }

    /// Within what distance of a face others coincide with it, of which at least one does [m]; by face, ascending.
    struct Reach {
        std::uint32_t face;
        float tolerance;
    };
    const std::vector<Reach>& reaches() const { return reaches_; }

    std::size_t hidden_count() const { return hidden_count_; }
    std::size_t overlapped_count() const { return first_.size() - 1; }
    std::size_t pair_count() const { return overlaps_.size(); }  ///< Overlapping faces, without the hidden ones.
    std::size_t memory() const;                                  ///< [bytes]

  private:
    /// A face that has priority over another.
    struct PriorityFace {
        PriorityFace(const Scene& scene, std::uint32_t face, float margin);

        /// Whether the ray is on a side that answers and x, in the face's plane, within its polygon.
        bool answers(const V3f& x, const V3f& direction) const;
        std::uint32_t side_towards(const V3f& direction) const;

        std::uint32_t front, back;  // back: none for a one-sided face
        V3f origin, normal;
        struct HalfPlanes {  // inside: inward . (x - origin) >= offset; an array for each number, to ask all at once
            std::array<float, 4> x, y, z, offset;
        };
        HalfPlanes inward;
    };

    void hide_duplicates(const Scene& scene, std::span<const std::uint32_t> rank);
    void find_overlaps(const Scene& scene, std::span<const std::uint32_t> rank, std::span<const float> tolerance);
    void measure_uncovered(const Scene& scene, std::span<const float> tolerance);
    const PriorityFace* find_priority_face(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    std::vector<bool> hidden_;  // by patch
    RankedBits overlapped_;     // likewise: faces that one of higher priority overlaps
    std::size_t hidden_count_ = 0;
    std::vector<PriorityFace> priority_faces_;  // by rank: of two, the first answers
    std::vector<std::size_t> first_{0};         // of each overlapped face in overlaps_, and the end
    std::vector<Boxed>
        overlaps_;        // of each overlapped face a tree of those of higher priority, indices of priority_faces_
    RankedBits covered_;  // patches that are covered, wholly or in part
    std::vector<float> uncovered_share_;  // of each of them
    std::vector<Reach> reaches_;
};

}  // namespace interflect::inline detail
