#pragma once

#include <ImathBox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/facet.h"
#include "interflect/geometry/planar_polygon.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// A segment on a facet, and for a part of the outline of a coplanar face the side on which that face lies.
struct FoundSegment {
    PlanarSegment segment;  ///< From the lexicographically lower end.
    int outline = 0;        ///< 1 or -1: left or right of it; 0 where a face stands on the facet or passes through it.
};

/// Finds the segments in which other facets meet one facet.
class ContactFinder {
  public:
    /// @param rank            rank_by_flat_surface() of the scene.
    /// @param touch_distance  As in ContactOptions.
    ContactFinder(const Scene& scene, const Facet& facet, std::span<const std::uint32_t> rank, double touch_distance);

    const PlanarPolygon& polygon() const { return polygon_; }
    const PlaneFrame& frame() const { return frame_; }

    /// How far from the facet another may be to touch it [m].
    float reach() const;
    /// Whether the facet's plane comes as close as reach() to the box.
    bool plane_meets(const Imath::Box3f& box) const;
    /// Finds the segments in which `other` meets the facet.
    void add_contacts_with(const Facet& other);
    /// The segments to cut along: those that are connected to others over at least `least_extent`.
    std::vector<PlanarSegment> segments(double least_extent);

  private:
    /// The segments, each once, without the borders between coplanar faces that hide the facet on both sides.
    std::vector<PlanarSegment> distinct_segments();
    /// For each segment the lowest one of its connected component: segments that share ends, within the tolerance.
    std::vector<std::uint32_t> connected(const std::vector<PlanarSegment>& segments) const;

    bool is_two_sided(const Facet& f) const { return scene_.patches[f.face].other_side != none; }

    bool starts_alike(std::size_t i, std::size_t j) const {
        return found_[j].segment.a.x - found_[i].segment.a.x <= facet_.detail();
    }
    bool is_same(const PlanarSegment& s, const PlanarSegment& t) const {
        return (s.a - t.a).length() <= facet_.detail() && (s.b - t.b).length() <= facet_.detail();
    }

    /// @param outline  The side of the segment from a to b on which a coplanar face lies, or 0.
    void add(const Imath::V3d& a, const Imath::V3d& b, int outline);
    void add_outline(const Facet& other);
    /// The other facet's intersection with this one's plane: between two corners that lie in it, or points where edges
    /// pass through it.
    void add_section(const Facet& other, const std::array<double, 4>& height, double touching);

    const Scene& scene_;
    const Facet& facet_;
    std::span<const std::uint32_t> rank_;
    double touch_distance_;
    PlaneFrame frame_;
    PlanarPolygon polygon_;
    std::vector<FoundSegment> found_;
};

}  // namespace interflect::inline detail
