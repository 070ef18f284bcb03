#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/surfaces/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Shades curved surfaces with CornerNormals: H(x) = H_solved(x) + G (n(x) - n_mean), where n is the interpolated
/// normal and G the gradient of the irradiance with respect to the normal (docs/method/method.md, Curved surfaces). The
/// correction is clamped to the largest step of irradiance across edges.
class SmoothNormals {
  public:
    SmoothNormals() = default;
    SmoothNormals(const Scene& scene, const SmoothSurfaces& surfaces);

    /// Corrects the irradiance at the centres of leaves, and clamps it to >= 0.
    /// @param irradiance  One value per element; only leaves change.
    void apply(const ElementForest& forest, std::vector<Rgb>& irradiance) const;

    /// Returns the unit normal of the curved surface, or the normal of the patch unless all its corners have normals.
    V3f at(const PatchGeometry& geometry, PatchIndex patch, Parameters p) const;

  private:
    /// Patch beyond an edge. Edges are numbered by their first corner.
    struct Neighbour {
        PatchIndex patch;
        std::uint32_t edge, other_edge;
    };
    struct CurvedPatch {
        PatchIndex patch;
        std::uint32_t first_neighbour = 0, last_neighbour = 0;
        std::array<V3f, 4> normals;

        V3f normal_at(bool is_triangle, Parameters p) const;
        V3f mean_normal(bool is_triangle) const;
    };
    struct Gradient {
        std::array<Imath::V3d, 3> by_normal;  ///< G of each channel.
        Rgb largest_change;                   ///< Largest step of irradiance across an edge.
    };

    Gradient gradient(const ElementForest& forest, std::span<const Rgb> irradiance, const CurvedPatch& curved) const;
    std::span<const Neighbour> neighbours(const CurvedPatch& curved) const {
        return std::span(neighbours_).subspan(curved.first_neighbour, curved.last_neighbour - curved.first_neighbour);
    }

    std::vector<CurvedPatch> curved_;
    std::vector<Neighbour> neighbours_;
};

}  // namespace interflect::detail
