#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth_normals.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// The vertices that the elements of a forest have on the scene's smooth surfaces. Elements that meet in a point of one
/// smooth surface share the vertex there, whichever their patches and levels; at creases, at borders of materials and
/// between the sides of a face every surface has its own. Numbered from 0, a vertex in the middle of an edge after the
/// edge's ends; the same for any number of threads. 16 bytes an element and 12 a hanging vertex stay; time about
/// linear.
class ElementVertices {
  public:
    /// A vertex inside an edge of a larger leaf (a T-vertex): smaller elements on the other side have it as a corner. A
    /// function that is linear along that edge has the interpolated value of its ends there.
    struct Hanging {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;  // the edge that they bound is the leaf's, or a part of it
        float fraction = 0.5f;              // of the way from ends[0] to ends[1]
    };
    /// A vertex on a seam (SmoothSurfaces::Seam) inside the edge of a leaf that is no larger than its own on the other
    /// side, whose vertices it lacks: that leaf counts there by its angle.
    struct Coupling {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;  // [rad]
    };

    /// @throws InputError for a forest of another scene.
    ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options = {});

    std::uint32_t count() const { return count_; }
    /// Of element e, leaf or not: in the order of its patch's vertices, so at (0,0) (1,0) (1,1) (0,1) of a
    /// quadrilateral's Cell and at (0,0) (1,0) (0,1) of a triangle's, whose fourth is none.
    const std::array<std::uint32_t, 4>& corners(std::uint32_t e) const { return corners_[e]; }
    /// In an order in which the ends of each come before it.
    const std::vector<Hanging>& hanging() const { return hanging_; }
    /// In no order: each counts what the leaves around its ends have, without couplings.
    const std::vector<Coupling>& couplings() const { return couplings_; }
    const SmoothNormals& normals() const { return normals_; }

  private:
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<Hanging> hanging_;
    std::vector<Coupling> couplings_;
    SmoothNormals normals_;
    std::uint32_t count_ = 0;
};

/// Irradiance at vertices from that of elements, of which only leaves count. On curved surfaces it varies within
/// patches as their normals do (SmoothNormals). At most vertices: the mean over the leaves that have the vertex as a
/// corner, weighted by their angles there. An angle does not change when a face is cut into triangles (Thuermer and
/// Wuethrich 1998), so the result does not depend on how a face was tessellated. At a hanging vertex: the interpolated
/// value of its edge's ends, so that the leaves on both sides of the edge agree along all of it. Across a seam leaves
/// of about equal size whose vertices lie apart differ by what linear interpolation leaves out: by the square of their
/// size.
std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance);

}  // namespace interflect::inline detail
