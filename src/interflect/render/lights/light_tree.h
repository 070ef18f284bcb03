#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples lights by estimated unoccluded irradiance at a point (Conty and Kulla 2018): power x upper bounds of the
/// cosines / squared distance. Constant methods are thread-safe.
class LightTree {
  public:
    struct Cone {
        V3f axis{0, 0, 1};
        float cosine = 1;  // cosine of the half angle; -1: all directions
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

    /// From now on, half of the choices are in proportion to weight times power; the other half still use the power
    /// alone. So no light loses more than half of its probability, even if its weight is wrong.
    /// @param weights  By index, above 0.
    void weigh(std::span<const float> weights);
    bool is_weighted() const { return is_weighted_; }

    /// Samples a light for point x on a surface with normal n. @param uniform  In (0, 1).
    Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// Returns the probability of choose(); 0 for an index without light.
    float probability(std::uint32_t index, const V3f& x, const V3f& n) const;

    std::size_t light_count() const { return light_count_; }

  private:
    static constexpr std::size_t width = 8;
    using Floats = std::array<float, width>;
    struct Vectors {
        Floats x{}, y{}, z{};
        void set(std::size_t i, const V3f& v) {
            x[i] = v.x;
            y[i] = v.y;
            z[i] = v.z;
        }
    };
    /// Up to eight children, which are lights or nodes. Unused children have no power.
    struct alignas(64) Node {
        Vectors centre, half_size;  // bounding boxes [m]
        Vectors axis;               // axes of the cones
        Floats cone_cosine{}, cone_sine{};
        Floats power{};           // [W or lm]
        Floats weighted_power{};  // power times the weights of weigh()
        Floats radius{};          // half diagonal of the box [m]; positive
        std::array<std::uint32_t, width> child{};
        std::array<bool, width> is_light{};
        std::uint32_t slot_in_parent = none;  // index of the parent times `width`, plus the number of this child
    };
    struct Choices {
        Floats importance;
        float sum;
    };
    struct BinaryNode;
    struct Split;
    struct Bin;

    static Cone bounding_cone(const Cone& a, const Cone& b);
    static Split best_split(std::span<const Light> lights, const Box& centres);
    static std::uint32_t build(std::span<Light> lights, std::vector<BinaryNode>& nodes);
    void add_node(const std::vector<BinaryNode>& binary, std::uint32_t root, std::uint32_t slot_in_parent);
    static Choices importance_of_children(const Node& node, const Floats& power, const V3f& x, const V3f& n);
    /// @param is_weighted  Whether to choose by the weighted power. The returned probability is the mean of both ways.
    Choice choose_by(bool is_weighted, const V3f& x, const V3f& n, double uniform) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t>
        slot_;  // slot of each light: index of its node times `width`, plus the number of the child
    std::size_t light_count_;
    bool is_weighted_ = false;
};

/// @param geometry, power  Per patch; only patches with power > 0 become lights.
std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power);

/// Returns the power per patch, sum of channels [W or lm], plus 1% of a texture's largest texel to keep it positive.
std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry);

}  // namespace interflect::detail
