#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Chooses emitting patches in proportion to an estimate of the irradiance that they cause at a point: a binary tree
/// over them, each node with the power, the bounding box and a cone around the normals of its patches. A walk from the
/// root takes a child with a probability proportional to power x cosines / squared distance. The cosines, of the
/// receiving surface and of the emitting ones, are the largest that the box and the cone allow. The distance is that to
/// the box's centre, at least half its diagonal. A node that lies behind the surface, or faces away from the point as a
/// whole, is never taken. After Conty and Kulla 2018. Occlusion is ignored. Immutable, shared by all threads; 64
/// bytes a node, two nodes an emitting patch, and 4 bytes a patch.
class LightTree {
  public:
    struct Choice {
        std::uint32_t patch = none;  ///< none where no patch can light the point.
        float probability = 0;
    };

    /// @param geometry  Of each patch of the scene.
    /// @param power     Of each patch, all channels together [W or lm]; those above 0 emit.
    LightTree(const Scene& scene, std::span<const PatchGeometry> geometry, std::span<const float> power);

    /// An emitting patch for the point x of a surface with normal n. @param uniform  In (0, 1). O(depth).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// The probability with which choose() takes an emitting `patch`; 0 for any other. O(depth).
    float probability(std::uint32_t patch, const V3f& x, const V3f& n) const;

    std::size_t emitting_patches() const { return (nodes_.size() + 1) / 2; }

  private:
    /// All normals within an angle of an axis.
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // of the angle; -1: all directions
    };
    struct Box {
        V3f low, high;
        void extend(const Box& other);
    };
    struct alignas(64) LightNode {
        V3f centre, half;  // of the bounding box; from its centre to a corner [m]
        Cone cone;
        float cone_sine = 0;
        float power = 0;                            // sum over channels [W or lm]
        std::uint32_t first_child = 0;              // the other one follows it; of an inner node
        std::uint32_t patch = none, parent = none;  // patch: of a leaf
        float radius2 = 0;                          // half.length2() [m^2]
        bool is_leaf() const { return patch != none; }
    };
    struct Emitter;
    struct Split;
    struct Bin;

    static Cone bounding_cone(const Cone& a, const Cone& b);
    static float importance(const LightNode& node, const V3f& x, const V3f& n);
    static Split best_split(std::span<const Emitter> emitters, const Box& centres);
    void build(std::uint32_t index, std::span<Emitter> emitters);

    std::vector<LightNode> nodes_;     // [0] is the root; empty without emitting patches
    std::vector<std::uint32_t> leaf_;  // of each patch; none where it does not emit
};

/// What each patch emits, all channels together [W or lm]. A patch with an exitance texture has the mean of it; a share
/// goes by the texture's largest texel, so that none that may emit is left out.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::inline detail
