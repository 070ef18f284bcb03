#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples lights by estimated irradiance at a point (Conty and Kulla 2018). A child's probability is proportional to
/// power x cosines / squared distance. Cosines are upper bounds; the distance is to the box's centre, at least half the
/// diagonal. Nodes behind the surface or facing away have probability 0. Ignores occlusion. Immutable, thread-safe.
/// Memory: 64 bytes per node (two per light), 4 per index.
class LightTree {
  public:
    /// Directions within an angle of an axis.
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // of that angle; -1: all directions
    };
    struct Box {
        V3f low, high;
        void extend(const Box& other);
    };
    /// Light whose intensity is at most power / pi times the cosine of the angle outside its cone.
    struct Light {
        std::uint32_t index;
        float power;  ///< Sum of channels [W or lm].
        Box box;
        Cone cone;
        V3f centre() const { return 0.5f * (box.low + box.high); }
    };
    struct Choice {
        std::uint32_t index = none;  ///< none: no light can reach the point.
        float probability = 0;
    };

    /// @param index_count  Greater than every index.
    LightTree(std::vector<Light> lights, std::size_t index_count);

    /// Samples a light for point x on a surface with normal n. O(depth).
    /// @param uniform  In (0, 1).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// Returns the probability that choose() returns this light; 0 for other indices. O(depth).
    float probability(std::uint32_t index, const V3f& x, const V3f& n) const;

    std::size_t light_count() const { return (nodes_.size() + 1) / 2; }

  private:
    struct alignas(64) LightNode {
        V3f centre, half;  // bounding box: centre and half diagonal [m]
        Cone cone;
        float cone_sine = 0;
        float power = 0;                            // sum of channels [W or lm]
        std::uint32_t first_child = 0;              // inner nodes; the second child follows
        std::uint32_t light = none, parent = none;  // light: index, leaves only
        float radius2 = 0;                          // half.length2() [m^2]
        bool is_leaf() const { return light != none; }
    };
    struct Split;
    struct Bin;

    static Cone bounding_cone(const Cone& a, const Cone& b);
    static float importance(const LightNode& node, const V3f& x, const V3f& n);
    static Split best_split(std::span<const Light> lights, const Box& centres);
    void build(std::uint32_t node, std::span<Light> lights);

    std::vector<LightNode> nodes_;     // [0] is the root
    std::vector<std::uint32_t> leaf_;  // node per index
};

/// @param geometry, power  Per patch; only patches with power > 0 become lights.
std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power);

/// Power per patch for sampling, sum of channels [W or lm]. Textures: mean plus 1% of the largest texel, which keeps
/// every emitter's power positive.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::detail
