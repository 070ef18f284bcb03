#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interflect/formats/gltf_buffers.h"

namespace interflect::inline detail {

/// Elements in memory, checked to lie within it: of one accessor.
struct GltfElements {
    const char* first = nullptr;
    std::size_t stride = 0;  ///< Bytes from one element to the next; 0: all are the same.
    std::uint64_t count = 0;
    int component_type = 0;   ///< glTF's number of it: 5126 is float.
    int components = 1;       ///< Of each element.
    bool normalized = false;  ///< Integers are fractions of their largest value.

    /// As a number, after normalisation. @param element, component  In range.
    double number(std::uint64_t element, int component) const;
    /// Of a type without sign, as it is.
    std::uint32_t whole_number(std::uint64_t element) const;
};

/// The accessors of a glTF file: sparse ones, those without data (zeros) and all component types.
class GltfAccessors {
  public:
    GltfAccessors(GltfAsset& asset, GltfBuffers& buffers);

    std::size_t count() const { return accessors_.size(); }
    /// @param index  Below count(). @param types  Accepted: "VEC3", "VEC3 VEC4". @param user  Named in errors.
    /// @return        valid while this lives. @throws GltfFault where its elements lie outside of their buffer.
    GltfElements elements(std::uint32_t index, const std::string& types, const GltfValue& user);
    /// Of indices: unsigned scalars that are not normalized.
    GltfElements indices(std::uint32_t index, const GltfValue& user);

  private:
    GltfElements in_view(const GltfValue& owner, const GltfElements& shape);
    const std::string& sparse(std::uint32_t index, const GltfElements& base);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    std::vector<GltfValue> accessors_;
    std::map<std::uint32_t, std::string> sparse_;  // their elements, packed
};

}  // namespace interflect::inline detail
