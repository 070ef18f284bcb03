#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interflect/formats/gltf_asset.h"

namespace interflect::inline detail {

/// A node of the scene, placed.
struct GltfNode {
    const GltfValue* value = nullptr;
    Imath::M44d to_world;
    std::string name;    ///< Its own; empty where it has none.
    std::string dotted;  ///< With those of its ancestors: "room.desk.leg".
};

/// The nodes of a glTF file, placed in the world.
class GltfNodes {
  public:
    /// @throws GltfFault for a node that is its own ancestor or has two parents, and for a transform that is none.
    explicit GltfNodes(GltfAsset& asset);

    std::size_t count() const { return values_.size(); }
    const Imath::M44d& to_world(std::uint32_t node) const { return to_world_[node]; }
    /// Those of the file's scene, or of its first one; where it has no scene, all. Parents come first.
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

/// Scaled, then turned by the quaternion (x, y, z, w), then moved. @throws GltfFault for a quaternion of length 0.
Imath::M44d gltf_transform(const Imath::V3d& scale, const std::array<double, 4>& rotation,
                           const Imath::V3d& translation, const GltfValue& owner);

}  // namespace interflect::inline detail
