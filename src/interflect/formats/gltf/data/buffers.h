#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/gltf/data/asset.h"

namespace interflect::detail {

/// Buffers and buffer views of a file. Decompresses views with EXT_meshopt_compression.
class GltfBuffers {
  public:
    struct View {
        std::string_view bytes;
        std::size_t stride = 0;  ///< Distance between elements [bytes]; 0 if they are packed.
    };

    /// @param parts  They must outlive this object.
    GltfBuffers(GltfAsset& asset, const GltfParts& parts);

    std::size_t view_count() const { return views_.size(); }
    View view(std::uint32_t index);

  private:
    std::string_view buffer(std::uint32_t index);
    std::string_view range(const GltfValue& owner);
    const std::string& decompressed(std::uint32_t index);

    GltfAsset& asset_;
    const GltfParts& parts_;
    std::vector<GltfValue> buffers_, views_;
    std::map<std::uint32_t, std::string> read_, decompressed_;  // keys: buffers, and views
};

}  // namespace interflect::detail
