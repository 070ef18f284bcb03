#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth_surfaces.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Shading of the curved surfaces that flat patches approximate, by the normals of the scene's file (Scene::normals).
/// The solver finds irradiance for the normal of each patch; on the curved surface it varies within the patch with the
/// normal. To first order,
///
///     H(x) = H_solved(x) + G (n(x) - n_mean)
///
/// with n(x) interpolated from the normals at the patch's corners and n_mean its mean. G, the gradient of irradiance by
/// normal, is a least-squares fit to the steps of irradiance across the edges to the patch's neighbours, where the
/// place is the same and the normal differs. No change exceeds the largest of these steps. The mean over a patch stays
/// the same. Patches without normals at all corners stay flat: a low crease angle does not tell a roof from a dome.
class SmoothNormals {
  public:
    SmoothNormals() = default;
    SmoothNormals(const Scene& scene, const SmoothSurfaces& surfaces);

    /// Adds G (n(x) - n_mean) at the centre of each leaf of a curved patch. Irradiance stays non-negative.
    /// @param irradiance  One for each element of a forest of the scene; changed at leaves only.
    void apply(const ElementForest& forest, std::vector<Rgb>& irradiance) const;

    /// Unit normal at a point of a patch; the patch's own normal on flat patches.
    V3f at(const ElementForest& forest, std::uint32_t patch, Parameters p) const;

  private:
    /// A common edge with another patch of the smooth surface; edges start at corners of the patches.
    struct Neighbour {
        std::uint32_t patch;
        std::uint32_t edge, other_edge;
    };
    struct CurvedPatch {
        std::uint32_t patch;
        std::uint32_t first_neighbour = 0, last_neighbour = 0;
        std::array<V3f, 4> normals;  // at its corners; a triangle has three

        V3f normal_at(bool is_triangle, Parameters p) const;
        V3f mean_normal(bool is_triangle) const;
    };
    struct Gradient {
        std::array<Imath::V3d, 3> by_normal;  ///< G: change of irradiance per change of the normal, for each channel.
        Rgb largest_change;  ///< The largest step to a neighbour: no change within the patch is larger.
    };

    Gradient gradient(const ElementForest& forest, std::span<const Rgb> irradiance, const CurvedPatch& curved) const;
    std::span<const Neighbour> neighbours(const CurvedPatch& curved) const {
        return std::span(neighbours_).subspan(curved.first_neighbour, curved.last_neighbour - curved.first_neighbour);
    }

    std::vector<CurvedPatch> curved_;  // by patch
    std::vector<Neighbour> neighbours_;
};

}  // namespace interflect::detail
