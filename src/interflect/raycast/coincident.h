#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/box_tree.h"
#include "interflect/raycast/ranked_bits.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// Faces that lie in one place, as a sheet of paper in the plane of its desk or two boxes with a common side, and which
/// of them answers a ray there. A ray tracer takes the one that it happens to test first: light would land on one while
/// the eye sees the other. Here the same one always answers, seen from wherever: that of the smaller surface (paper on
/// a desk; see flat_surfaces.h for what is one surface), of equal surfaces the one that comes first in the scene. A
/// one-sided face answers, and takes part at all, only where it is seen from its front.
///
/// Two faces coincide where they overlap in (nearly) one plane: where one's polygon reaches more than `tolerance` into
/// the other's, and all of what they share lies within `tolerance` of the larger one's plane; or where they have the
/// same corners. Faces that share an edge only do not.
///
/// A face is named by its patch, of a two-sided one by the first. Memory: a bit a patch where nothing coincides, else
/// 3, and 96 bytes more for each face that others give way to, 28 for each pair.
class CoincidentFaces {
  public:
    /// Finds all that coincide: O(n log n) for n patches of which each overlaps a bounded number of others.
    /// @param scene      Valid (scene_faults); convex quadrilaterals.
    /// @param tolerance  [m], > 0.
    CoincidentFaces(const Scene& scene, float tolerance);

    /// Whether the face has the corners of another that answers wherever it could: it may be left out.
    bool is_hidden(std::uint32_t face) const { return hidden_[face]; }

    /// Whether the face gives way to another on a part of it, so that a ray that meets it must ask for answering_patch.
    bool is_contested(std::uint32_t face) const { return contested_[face]; }

    /// Which patch answers a ray whose first hit is the contested `face` at x: the side that the ray sees of the face
    /// that is there in its stead; none where `face` itself answers. O(log k) time for k faces that overlap it.
    std::uint32_t answering_patch(std::uint32_t face, const V3f& x, const V3f& direction) const;

    std::size_t hidden_count() const { return hidden_count_; }
    std::size_t contested_count() const { return first_.size() - 1; }
    std::size_t pair_count() const { return stand_ins_.size(); }  ///< Overlapping faces, without the hidden ones.
    std::size_t memory() const;                                   ///< [bytes]

  private:
    /// A face that others give way to.
    struct Winner {
        Winner(const Scene& scene, std::uint32_t face, float margin);

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
    void find_stand_ins(const Scene& scene, std::span<const std::uint32_t> rank, float tolerance);
    const Winner* stand_in(std::uint32_t face, const V3f& x, const V3f& direction) const;

    std::vector<bool> hidden_;  // by patch
    RankedBits contested_;      // likewise: the losers
    std::size_t hidden_count_ = 0;
    std::vector<Winner> winners_;        // by rank: of two, the first answers
    std::vector<std::size_t> first_{0};  // of each loser in stand_ins_, and the end
    std::vector<Boxed> stand_ins_;       // of each loser a tree of those that it gives way to: indices of winners_
};

}  // namespace interflect
