#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interflect/formats/gltf/data/asset.h"

namespace interflect::detail {

struct GltfNode {
    std::uint32_t index = 0;
    const GltfValue* value = nullptr;
    Imath::M44d to_world;
    std::string name;
    std::string dotted;  ///< Name after those of its ancestors, such as "room.desk.leg".
};

class GltfNodes {
  public:
    /// @throws GltfFault for cycles, two parents or invalid transforms.
    explicit GltfNodes(GltfAsset& asset);

    std::size_t count() const { return values_.size(); }
    const Imath::M44d& to_world(std::uint32_t node) const { return to_world_[node]; }
    /// Returns the nodes of the default or the first scene, or all nodes of a file without scenes. Parents come first.
    std::vector<GltfNode> in_scene() const;

  private:
    std::vector<std::uint32_t> roots_of_scene() const;
    template <class Visit>
    void traverse(const std::vector<std::uint32_t>& roots, const Visit& visit) const;

    GltfAsset& asset_;
    std::vector<GltfValue> values_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<std::uint32_t> parents_;
    std::vector<Imath::M44d> to_world_;
};

/// Returns the matrix that scales, rotates by a quaternion (x, y, z, w), then translates.
/// @throws GltfFault for a zero quaternion.
Imath::M44d gltf_transform(const Imath::V3d& scale, const std::array<double, 4>& rotation,
                           const Imath::V3d& translation, const GltfValue& owner);

}  // namespace interflect::detail
