#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/exports/authored/authored_charts.h"
#include "interflect/exports/lightmap/texels.h"
#include "interflect/exports/mesh/shown_patches.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Moves texels from the triangles of a file to the patches of the solved scene, which contacts have cut into pieces.
/// A texel gets the light of the front, or of the back in charts with unlit fronts and on solids turned inside out.
/// Texels that are hidden, between two objects, or unlit where another face touches theirs, lose
/// TexelPlace::is_evaluated: they copy the light beside them.
class TexelMover {
  public:
    /// Refers to its arguments. @param visibility  Visibility of the patches of `solved`.
    TexelMover(const AuthoredCharts& authored, const Scene& solved, const PatchVisibility& visibility);

    void move(std::size_t chart, std::span<TexelPlace> places);

    /// Returns whether most of an object is lit on both sides. Its lightmap contains one side.
    bool is_lit_on_both_sides(std::size_t object) const { return 2 * sides_[object].both > sides_[object].front; }

  private:
    /// The patches at a point of a face.
    struct Faces {
        PatchIndex front, back;
        bool touches;                  ///< Whether another face touches this one at the point.
        bool meets_front, meets_back;  ///< Whether the front of a touching face of another object faces this side.
    };
    /// Edges of a triangle, and a point on it relative to Scene::origin [m].
    struct Surface {
        Imath::V3d u, v;
        V3f x;
    };
    /// Numbers of texels with a lit front, and with both sides lit.
    struct LitSides {
        std::uint64_t front = 0, both = 0;
    };
    Faces find(const V3f& x, const V3f& normal, std::uint32_t object) const;
    bool shows(PatchIndex p) const { return p != none && visibility_.lit[p] && !visibility_.hidden[p]; }
    void count_sides(std::span<const Faces> faces, LitSides& sides) const;
    Surface surface_of(const AuthoredObject& object, PatchIndex patch, Parameters at) const;
    void find_inverted_parts(const AuthoredObject& object);

    const AuthoredCharts& authored_;
    const Scene& solved_;
    const PatchVisibility& visibility_;
    std::vector<std::uint32_t> object_of_chart_;
    std::vector<PatchGeometry> geometries_;
    std::vector<Boxed> tree_;
    float reach_ = 0;                // tolerance of positions [m]
    std::vector<bool> is_inverted_;  // for each chart, whether the fronts of its part are inside a solid
    std::vector<LitSides> sides_;    // one entry per object
};

}  // namespace interflect::detail
