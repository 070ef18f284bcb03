#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples lights by their estimated irradiance at a point (Conty and Kulla 2018). Each node of the binary tree stores
/// power, bounding box and normal cone of its lights. The probability of a child is proportional to power x cosines /
/// squared distance. The cosines are upper bounds; the distance is to the box's centre, at least half the diagonal.
/// Nodes behind the surface or facing away have probability 0. Occlusion is ignored. Immutable, shared by all threads.
/// Memory: 64 bytes per node, two nodes per light, 4 bytes per index.
class LightTree {
  public:
    /// All directions within an angle of an axis.
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // of that angle; -1: all directions
    };
    struct Box {
        V3f low, high;
        void extend(const Box& other);
    };
    /// Light whose intensity in a direction is at most power / pi times the cosine of the angle outside its cone.
    struct Light {
        std::uint32_t index;
        float power;  ///< Sum over channels [W or lm].
        Box box;
        Cone cone;
        V3f centre() const { return 0.5f * (box.low + box.high); }
    };
    struct Choice {
        std::uint32_t index = none;  ///< none if no light can reach the point.
        float probability = 0;
    };

    /// @param index_count  Greater than every index.
    LightTree(std::vector<Light> lights, std::size_t index_count);

    /// Samples a light for the point x of a surface with normal n. @param uniform  In (0, 1). O(depth).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// Returns the probability that choose() returns this light; 0 for other indices. O(depth).
    float probability(std::uint32_t index, const V3f& x, const V3f& n) const;

    std::size_t light_count() const { return (nodes_.size() + 1) / 2; }

  private:
    struct alignas(64) LightNode {
        V3f centre, half;  // of the bounding box; half: from the centre to a corner [m]
        Cone cone;
        float cone_sine = 0;
        float power = 0;                            // sum over channels [W or lm]
        std::uint32_t first_child = 0;              // of an inner node; the second child follows it
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
    std::vector<std::uint32_t> leaf_;  // node per index; none without a light
};

/// Converts patches with power > 0 to lights. @param geometry, power  Per patch of the scene.
std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power);

/// Returns each patch's emitted power for sampling, sum over channels [W or lm]. Textures use the mean plus 1% of the
/// largest texel, which keeps the power of every emitter positive.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::detail
