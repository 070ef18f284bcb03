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

/// Segment in which another face meets a facet.
struct FoundSegment {
    PlanarSegment segment;  ///< `a` is the lexicographically lower end.
    int outline = 0;        ///< Side of a coplanar face bounded by the segment: 1 left, -1 right; 0: other contacts.
};

class ContactFinder {
  public:
    /// @param rank  rank_by_flat_surface() of the scene.
    ContactFinder(const Scene& scene, const Facet& facet, std::span<const std::uint32_t> rank, double touch_distance);

    const PlanarPolygon& polygon() const { return polygon_; }
    const PlaneFrame& frame() const { return frame_; }

    /// Maximum distance of a touching facet [m].
    float reach() const;
    bool plane_meets(const Imath::Box3f& box) const;
    void add_contacts_with(const Facet& other);
    /// Returns the segments in connected components at least `least_extent` [m] wide.
    std::vector<PlanarSegment> segments(double least_extent);

  private:
    /// Removes duplicates, and borders between coplanar faces that cover the facet on both sides.
    std::vector<PlanarSegment> distinct_segments();
    /// Returns the component of each segment, as its lowest index. Segments with a common end are connected.
    std::vector<std::uint32_t> connected(const std::vector<PlanarSegment>& segments) const;

    bool is_two_sided(const Facet& f) const { return scene_.patches[f.face].other_side != none; }

    bool starts_alike(std::size_t i, std::size_t j) const {
        return found_[j].segment.a.x - found_[i].segment.a.x <= facet_.detail();
    }
    bool is_same(const PlanarSegment& s, const PlanarSegment& t) const {
        return (s.a - t.a).length() <= facet_.detail() && (s.b - t.b).length() <= facet_.detail();
    }

    void add(const Imath::V3d& a, const Imath::V3d& b, int outline);
    void add_outline(const Facet& other);
    /// Adds the intersection of `other` with this facet's plane.
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
