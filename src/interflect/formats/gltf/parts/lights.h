#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "interflect/formats/gltf/data/buffers.h"
#include "interflect/formats/gltf/parts/nodes.h"

namespace interflect::detail {

/// Adds the light sources and cameras of nodes to the model.
class GltfLights {
  public:
    GltfLights(GltfAsset& asset, GltfBuffers& buffers);

    void add(const GltfNode& node, std::uint32_t object);
    bool has_light(const GltfNode& node) const;

  private:
    void add_punctual(const GltfNode& node, std::uint32_t object);
    void add_measured(const GltfNode& node, std::uint32_t object);
    void add_view(const GltfNode& node);
    void add_light(Luminaire luminaire, const GltfNode& node, const std::string& name);
    std::shared_ptr<const PhotometricWeb> web(std::uint32_t profile);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    std::vector<GltfValue> punctual_, profiles_, cameras_;
    std::map<std::uint32_t, std::shared_ptr<const PhotometricWeb>> webs_;
    std::set<std::string> light_names_, view_names_;
};

}  // namespace interflect::detail
