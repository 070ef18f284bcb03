#pragma once

#include <ImathBox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Plane face, or one of the two triangles of a warped quadrilateral.
struct Facet {
    std::uint32_t face = none;  ///< Index of the face's front patch.
    std::array<std::uint32_t, 4> vertices{none, none, none, none};
    std::size_t count = 0;
    std::array<Imath::V3d, 4> corners{};  ///< [m]
    Imath::V3d normal{0, 0, 0};           ///< Unit length.
    double diameter = 0;                  ///< [m]
    double rounding = 0;                  ///< Rounding error of corners [m].

    Facet() = default;
    /// @param corner_vertices  Indices of three or four vertices.
    Facet(const Scene& scene, std::uint32_t face_index, std::span<const std::uint32_t> corner_vertices);

    double area() const { return area_; }  ///< [m^2]

    /// Returns the signed distance from the plane [m].
    double height(const Imath::V3d& x) const { return normal.dot(x - corners[0]); }
    /// Length below which features are ignored [m].
    double detail() const;

    Imath::Box3f box(float margin) const;  ///< Returns the bounding box, enlarged by `margin` [m].

  private:
    double area_ = 0;
};

std::vector<Facet> facets_of(const Scene& scene);

/// Right-handed frame of a facet's plane, whose x axis is along the facet's longest edge.
class PlaneFrame {
  public:
    explicit PlaneFrame(const Facet& facet);

    Imath::V2d in_plane(const Imath::V3d& p) const { return {x_.dot(p - origin_), y_.dot(p - origin_)}; }
    V3f in_space(const Imath::V2d& p) const { return V3f(origin_ + x_ * p.x + y_ * p.y); }

  private:
    Imath::V3d origin_, normal_, x_, y_;
};

}  // namespace interflect::detail
