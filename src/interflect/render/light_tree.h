#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples lights by estimated unoccluded irradiance at a point (Conty and Kulla 2018): power x upper bounds of the
/// cosines / squared distance. Thread-safe.
class LightTree {
  public:
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // of the half angle; -1: all directions
    };
    struct Box {
        V3f low, high;
        void extend(const Box& other);
    };
    /// Intensity is at most power / pi times the cosine of the angle outside the cone.
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

    /// Samples a light for point x on a surface with normal n. @param uniform  In (0, 1).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// Returns the probability of choose(); 0 for an index without light.
    float probability(std::uint32_t index, const V3f& x, const V3f& n) const;

    std::size_t light_count() const { return (nodes_.size() + 1) / 2; }

  private:
    struct alignas(64) LightNode {
        V3f centre, half;  // of the bounding box [m]
        Cone cone;
        float cone_sine = 0;
        float power = 0;  // [W or lm]
        std::uint32_t first_child = 0;
        std::uint32_t light = none, parent = none;
        float radius2 = 0;  // [m^2]
        bool is_leaf() const { return light != none; }
    };
    struct Split;
    struct Bin;

    static Cone bounding_cone(const Cone& a, const Cone& b);
    static float importance(const LightNode& node, const V3f& x, const V3f& n);
    static Split best_split(std::span<const Light> lights, const Box& centres);
    void build(std::uint32_t node, std::span<Light> lights);

    std::vector<LightNode> nodes_;
    std::vector<std::uint32_t> leaf_;
};

/// @param geometry, power  Per patch; only patches with power > 0 become lights.
std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power);

/// Returns the power per patch, sum of channels [W or lm], plus 1% of a texture's largest texel, which keeps it
/// positive.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::detail
