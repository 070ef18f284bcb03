#pragma once

#include <ImathBox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/geometry/contacts/facet.h"
#include "interflect/geometry/polygons/planar_polygon.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct FoundSegment {
    PlanarSegment segment;  ///< `a` is the lexicographically lower end.
    /// Side of an outline on which its coplanar face lies: 1 is left, -1 right. It is 0 for sections.
    int outline = 0;
};

/// Finds the contacts of one facet: sections with facets at an angle to it, and outlines of coplanar facets.
class ContactFinder {
  public:
    /// @param rank            Result of rank_by_flat_surface().
    /// @param touch_distance  Distance that counts as touching, relative to the smaller facet's diameter.
    /// @param gap             Maximum distance at which separate large facets count as touching [m].
    ContactFinder(const Scene& scene, const Facet& facet, std::span<const std::uint32_t> rank, double touch_distance,
                  double gap);

    const PlanarPolygon& polygon() const { return polygon_; }
    const PlaneFrame& frame() const { return frame_; }

    /// Maximum distance of a facet that counts as touching [m].
    float reach() const;
    bool plane_meets(const Imath::Box3f& box) const;
    void add_contacts_with(const Facet& other);
    bool has_contacts() const { return !found_.empty(); }
    /// Returns the segments of those connected components that are at least `min_extent` [m] wide.
    std::vector<PlanarSegment> segments(double min_extent);

  private:
    /// Returns each segment once, without the borders that two coplanar faces share.
    std::vector<PlanarSegment> distinct_segments();
    /// Returns, for each segment, the lowest index in its connected component. Segments with a common end are
    /// connected.
    std::vector<std::uint32_t> components(const std::vector<PlanarSegment>& segments) const;

    bool is_two_sided(const Facet& f) const { return scene_.patches[f.face].other_side != none; }

    bool starts_alike(std::size_t i, std::size_t j) const {
        return found_[j].segment.a.x - found_[i].segment.a.x <= facet_.detail();
    }
    bool is_same(const PlanarSegment& s, const PlanarSegment& t) const {
        return (s.a - t.a).length() <= facet_.detail() && (s.b - t.b).length() <= facet_.detail();
    }

    void add(const Imath::V3d& a, const Imath::V3d& b, int outline);
    void add_outline(const Facet& other);
    void add_section(const Facet& other, const std::array<double, 4>& height, double touching);

    const Scene& scene_;
    const Facet& facet_;
    std::span<const std::uint32_t> rank_;
    double touch_distance_, gap_;
    PlaneFrame frame_;
    PlanarPolygon polygon_;
    std::vector<FoundSegment> found_;
};

}  // namespace interflect::detail
