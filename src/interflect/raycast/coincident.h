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

namespace interflect::detail {

/// Faces in the same place, such as paper on a desk, and their priority. A ray tracer returns the face that it tests
/// first, so light and camera rays could hit different faces. Here the same face always answers: the smaller surface
/// (flat_surfaces.h), then the emitter (a lamp in place of a ceiling tile), then the first in the scene. One-sided
/// faces take part only where rays see their front.
///
/// Faces coincide if one polygon reaches more than pair_tolerance() (face_overlap.h) into the other and their common
/// part lies within that distance of the larger face's plane, or if they have the same corners; a common edge is not
/// enough. Covered parts must not emit rays: see uncovered_share().
///
/// A face is identified by its first patch. Memory: 1 bit per patch without coincident faces, otherwise 5, plus 96
/// bytes per face with priority and 28 per pair.
class CoincidentFaces {
  public:
    /// Finds all coincident faces: O(n log n) for n patches if each overlaps a bounded number of others.
    /// @param scene      Valid (scene_faults); convex quadrilaterals.
    /// @param tolerance  Coordinate error of each face [m], > 0. Size scene.patches.size().
    CoincidentFaces(const Scene& scene, std::span<const float> tolerance);
    CoincidentFaces(const Scene& scene, float tolerance)
        : CoincidentFaces(scene, std::vector<float>(scene.patches.size(), tolerance)) {}

    /// Whether another face with the same corners answers all of its rays.
    bool is_hidden(std::uint32_t face) const { return hidden_[face]; }

    /// Whether a face of higher priority overlaps it in part. Its hits must then use answering_patch().
    bool is_overlapped(std::uint32_t face) const { return overlapped_[face]; }

    /// Returns the patch that answers a ray whose first hit is the overlapped `face` at x: the visible side of the face
    /// with priority, or `none` for `face` itself. O(log k) for k faces that overlap it.
    /// @param x_error  Maximum distance of x from the face [m].
    std::uint32_t answering_patch(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    /// Returns the share of a patch's area, in [0, 1], that answers rays from its side: 0 if hidden or completely
    /// covered, 1 without coincident faces. Slivers as wide as the tolerance count as covered.
    float uncovered_share(std::uint32_t patch) const {
        return covered_[patch] ? uncovered_share_[covered_.rank(patch)] : 1.0f;
    }

    bool has_covered_patches() const { return !uncovered_share_.empty(); }

    /// Largest distance within which another face coincides with `face` [m]; only such faces, ascending.
    struct Reach {
        std::uint32_t face;
        float tolerance;
    };
    const std::vector<Reach>& reaches() const { return reaches_; }

    std::size_t hidden_count() const { return hidden_count_; }
    std::size_t overlapped_count() const { return first_.size() - 1; }
    std::size_t pair_count() const { return overlaps_.size(); }  ///< Overlapping faces that are not hidden.
    std::size_t memory() const;                                  ///< [bytes]

  private:
    struct PriorityFace {
        PriorityFace(const Scene& scene, std::uint32_t face, float margin);

        /// Whether the ray sees a side that answers and x, in the face's plane, is inside.
        bool answers(const V3f& x, const V3f& direction) const;
        std::uint32_t side_towards(const V3f& direction) const;

        std::uint32_t front, back;  // back: none for a one-sided face
        V3f origin, normal;
        struct HalfPlanes {  // inside: inward . (x - origin) >= offset; separate arrays, to test all edges at once
            std::array<float, 4> x, y, z, offset;
        };
        HalfPlanes inward;
    };

    void hide_duplicates(const Scene& scene, std::span<const std::uint32_t> rank);
    void find_overlaps(const Scene& scene, std::span<const std::uint32_t> rank, std::span<const float> tolerance);
    void measure_uncovered(const Scene& scene, std::span<const float> tolerance);
    const PriorityFace* find_priority_face(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    std::vector<bool> hidden_;  // per patch
    RankedBits overlapped_;     // per patch: a face of higher priority overlaps it
    std::size_t hidden_count_ = 0;
    std::vector<PriorityFace> priority_faces_;  // by rank: the first of two answers
    std::vector<std::size_t> first_{0};         // start of each overlapped face in overlaps_, and the end
    // Per overlapped face: tree of faces with higher priority, as indices of priority_faces_.
    std::vector<Boxed> overlaps_;
    RankedBits covered_;                  // patches covered completely or in part
    std::vector<float> uncovered_share_;  // of each of these
    std::vector<Reach> reaches_;
};

}  // namespace interflect::detail
