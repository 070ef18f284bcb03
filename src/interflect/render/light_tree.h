#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Chooses lights in proportion to an estimate of the irradiance that they cause at a point: a binary tree over them,
/// each node with the power, the bounding box and a cone around the normals of its lights. A walk from the root takes a
/// child with a probability proportional to power x cosines / squared distance. The cosines, of the receiving surface
/// and of the emitting ones, are the largest that the box and the cone allow. The distance is that to the box's centre,
/// at least half its diagonal. A node that lies behind the surface, or faces away from the point as a whole, is never
/// taken. After Conty and Kulla 2018. Occlusion is ignored. Immutable, shared by all threads; 64 bytes a node, two
/// nodes a light, and 4 bytes an index.
class LightTree {
  public:
    /// All normals within an angle of an axis.
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // of the angle; -1: all directions
    };
    struct Box {
        V3f low, high;
        void extend(const Box& other);
    };
    /// What the tree knows of a light: its intensity in a direction is at most power / pi times the cosine of the angle
    /// by which that lies outside its cone.
    struct Light {
        std::uint32_t index;
        float power;  ///< All channels together [W or lm].
        Box box;
        Cone cone;
        V3f centre() const { return 0.5f * (box.low + box.high); }
    };
    struct Choice {
        std::uint32_t index = none;  ///< none where no light can reach the point.
        float probability = 0;
    };

    /// @param index_count  Indices of lights are below it.
    LightTree(std::vector<Light> lights, std::size_t index_count);

    /// A light for the point x of a surface with normal n. @param uniform  In (0, 1). O(depth).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// The probability with which choose() takes the light of this index; 0 where there is none. O(depth).
    float probability(std::uint32_t index, const V3f& x, const V3f& n) const;

    std::size_t light_count() const { return (nodes_.size() + 1) / 2; }

  private:
    struct alignas(64) LightNode {
        V3f centre, half;  // of the bounding box; from its centre to a corner [m]
        Cone cone;
        float cone_sine = 0;
        float power = 0;                            // sum over channels [W or lm]
        std::uint32_t first_child = 0;              // the other one follows it; of an inner node
        std::uint32_t light = none, parent = none;  // light: index, of a leaf
        float radius2 = 0;                          // half.length2() [m^2]
        bool is_leaf() const { return light != none; }
    };
    struct Split;
    struct Bin;

    static Cone bounding_cone(const Cone& a, const Cone& b);
    static float importance(const LightNode& node, const V3f& x, const V3f& n);
    static Split best_split(std::span<const Light> lights, const Box& centres);
    void build(std::uint32_t node, std::span<Light> lights);

    std::vector<LightNode> nodes_;     // [0] is the root; empty without lights
    std::vector<std::uint32_t> leaf_;  // of each index; none where there is no light
};

/// Patches as lights. @param geometry, power  Of each patch of the scene; those with a power above 0 are lights.
std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power);

/// What each patch emits, all channels together [W or lm]. A patch with an exitance texture has the mean of it; a share
/// goes by the texture's largest texel, so that none that may emit is left out.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::inline detail
