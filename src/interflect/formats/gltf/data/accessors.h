#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interflect/formats/gltf/data/buffers.h"

namespace interflect::detail {

/// Elements of an accessor, whose bounds have been checked.
struct GltfElements {
    const char* first = nullptr;
    std::size_t stride = 0;  ///< [bytes]; 0: all elements are equal.
    std::uint64_t count = 0;
    int component_type = 0;  ///< glTF constant; 5126 is float.
    int components = 1;
    bool normalized = false;  ///< Integers are fractions of their largest value.

    /// Returns a component; applies `normalized`.
    double number(std::uint64_t element, int component) const;
    /// Returns a component of an unsigned type.
    std::uint32_t whole_number(std::uint64_t element) const;
};

/// Accessors of a file, which may be sparse. Accessors without data contain zeros.
class GltfAccessors {
  public:
    GltfAccessors(GltfAsset& asset, GltfBuffers& buffers);

    std::size_t count() const { return accessors_.size(); }
    /// @param types  Accepted types, such as "VEC3 VEC4". @return  Valid while this object lives. @throws GltfFault
    GltfElements elements(std::uint32_t index, const std::string& types, const GltfValue& owner);
    /// Returns the elements of an accessor of unsigned scalars.
    GltfElements indices(std::uint32_t index, const GltfValue& owner);

  private:
    /// Returns elements of a buffer view, after checking their bounds.
    GltfElements in_view(const GltfValue& owner, const GltfElements& shape);
    /// Returns the bytes of a sparse accessor. @param base  The elements before their replacement.
    const std::string& sparse(std::uint32_t index, const GltfElements& base);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    std::vector<GltfValue> accessors_;
    std::map<std::uint32_t, std::string> sparse_;
};

}  // namespace interflect::detail
