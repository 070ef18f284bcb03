#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/numbers/ranked_bits.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Resolves hits on coincident faces: a ray tracer reports whichever face it tests first. The face of highest priority
/// intercepts a ray: smaller flat surface (flat_surfaces.h), then emitters, then scene order. One-sided faces intercept
/// only rays to their front. Faces, identified by their first patches, coincide if they have the same corners or are
/// overlapping_faces().
class CoincidentFaces {
  public:
    /// @param scene      Valid (scene_faults), with convex quadrilaterals.
    /// @param tolerance  Coordinate error per patch [m], > 0.
    CoincidentFaces(const Scene& scene, std::span<const float> tolerance);
    CoincidentFaces(const Scene& scene, float tolerance)
        : CoincidentFaces(scene, std::vector<float>(scene.patches.size(), tolerance)) {}

    /// Whether another face with its corners intercepts all its rays.
    bool is_hidden(std::uint32_t face) const { return hidden_[face]; }

    /// Whether a face of higher priority covers a part of this face. Its hits then require intercepting_patch().
    bool is_overlapped(std::uint32_t face) const { return overlapped_[face]; }

    /// Returns the patch that intercepts a ray with a first hit at x on the overlapped `face`; `none`: `face` itself.
    /// @param x_error  Maximum distance of x from the face [m].
    PatchIndex intercepting_patch(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    /// Returns the share of a patch that intercepts rays; the rest must not emit. Slivers count as covered.
    float uncovered_share(PatchIndex patch) const {
        return covered_[patch] ? uncovered_share_[covered_.rank(patch)] : 1.0f;
    }

    bool has_covered_patches() const { return !uncovered_share_.empty(); }

    /// Largest pair_tolerance() of an overlapping face [m].
    struct FaceTolerance {
        std::uint32_t face;
        float tolerance;
    };
    /// Sorted by face.
    const std::vector<FaceTolerance>& tolerances() const { return tolerances_; }

    std::size_t hidden_count() const { return hidden_count_; }
    std::size_t overlapped_count() const { return overlap_begin_.size() - 1; }
    std::size_t pair_count() const { return overlaps_.size(); }  ///< Excludes hidden faces.
    std::size_t memory() const;                                  ///< [bytes]

  private:
    struct PriorityFace {
        PriorityFace(const Scene& scene, std::uint32_t face, float margin);

        bool intercepts(const V3f& x, const V3f& direction) const;
        /// Returns the side that a ray of this direction hits, or `none`.
        PatchIndex side_hit_by(const V3f& direction) const;

        PatchIndex front, back;
        V3f origin, normal;
        struct HalfPlanes {  // inside: inward . (x - origin) >= offset; separate arrays allow SIMD
            std::array<float, 4> x, y, z, offset;
        };
        HalfPlanes inward;
    };

    void hide_duplicates(const Scene& scene, std::span<const std::uint32_t> rank);
    void find_overlaps(const Scene& scene, std::span<const std::uint32_t> rank, std::span<const float> tolerance);
    void measure_uncovered(const Scene& scene, std::span<const float> tolerance);
    const PriorityFace* find_priority_face(std::uint32_t face, const V3f& x, const V3f& direction, float x_error) const;

    std::vector<bool> hidden_;
    RankedBits overlapped_;
    std::size_t hidden_count_ = 0;
    std::vector<PriorityFace> priority_faces_;   // by rank
    std::vector<std::size_t> overlap_begin_{0};  // start of each overlapped face in overlaps_, and the end
    // Box trees of indices into priority_faces_, one for each overlapped face.
    std::vector<Boxed> overlaps_;
    RankedBits covered_;                  // patches that are covered completely or in part
    std::vector<float> uncovered_share_;  // of each covered patch
    std::vector<FaceTolerance> tolerances_;
};

}  // namespace interflect::detail
