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

namespace interflect::detail {

/// A segment on a facet. If it belongs to the outline of a coplanar face, `outline` is the side of that face.
struct FoundSegment {
    PlanarSegment segment;  ///< `a` is the lexicographically lower end.
    int outline = 0;        ///< 1: left, -1: right; 0 if a face stands on the facet or passes through it.
};

/// Finds the segments in which other facets meet one facet.
class ContactFinder {
  public:
    /// @param rank            rank_by_flat_surface() of the scene.
    /// @param touch_distance  As in ContactOptions.
    ContactFinder(const Scene& scene, const Facet& facet, std::span<const std::uint32_t> rank, double touch_distance);

    const PlanarPolygon& polygon() const { return polygon_; }
    const PlaneFrame& frame() const { return frame_; }

    /// Maximum distance of a touching facet [m].
    float reach() const;
    bool plane_meets(const Imath::Box3f& box) const;
    void add_contacts_with(const Facet& other);
    /// Segments to cut along: those in connected components with an extent of at least `least_extent`.
    std::vector<PlanarSegment> segments(double least_extent);

  private:
    /// Removes duplicates, and borders between coplanar faces that hide the facet on both sides.
    std::vector<PlanarSegment> distinct_segments();
    /// Lowest segment index of each connected component. Segments with a common end are connected.
    std::vector<std::uint32_t> connected(const std::vector<PlanarSegment>& segments) const;

    bool is_two_sided(const Facet& f) const { return scene_.patches[f.face].other_side != none; }

    bool starts_alike(std::size_t i, std::size_t j) const {
        return found_[j].segment.a.x - found_[i].segment.a.x <= facet_.detail();
    }
    bool is_same(const PlanarSegment& s, const PlanarSegment& t) const {
        return (s.a - t.a).length() <= facet_.detail() && (s.b - t.b).length() <= facet_.detail();
    }

    /// @param outline  Side of a coplanar face, as in FoundSegment.
    void add(const Imath::V3d& a, const Imath::V3d& b, int outline);
    void add_outline(const Facet& other);
    /// Adds the intersection of the other facet with this facet's plane.
    void add_section(const Facet& other, const std::array<double, 4>& height, double touching);

    const Scene& scene_;
    const Facet& facet_;
    std::span<const std::uint32_t> rank_;
    double touch_distance_;
    PlaneFrame frame_;
    PlanarPolygon polygon_;
    std::vector<FoundSegment> found_;
};

}  // namespace interflect::detail
