#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "interflect/core.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/image.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// A glTF file under construction: its JSON and its binary buffer.
class GltfDocument {
  public:
    GltfDocument();
    /// Continues a file. @param buffer  Bytes of its first buffer.
    GltfDocument(Json file, std::string buffer) : json(std::move(file)), buffer_(std::move(buffer)) {}

    /// The JSON without the description of the first buffer.
    Json json;

    /// Appends an object to an array such as "materials". Returns its index.
    int add(const char* array, Json object);
    void use_extension(const char* name);

    /// The following functions add vertex data and return the index of the accessor.
    int add_positions(std::span<const V3f> values);  ///< Also adds bounds, which glTF requires.
    int add_attribute(std::span<const Rgb> values);
    int add_attribute(std::span<const V2f> values);
    int add_indices(std::span<const std::uint32_t> values);
    /// @param accessor  JSON of the accessor without the position of its data.
    /// @param stride    Distance from element to element [bytes].
    int add_elements(Json accessor, std::string_view bytes, std::size_t stride);
    int add_buffer_view(std::string_view bytes);

    /// Adds a texture as 8-bit sRGB PNG, clamped to [0, 1]. Returns its index.
    /// @param opacity  Alpha in [0, 1]; empty: no alpha channel.
    /// @param repeats  Whether the texture repeats, with mipmaps. Else the texels at the edge continue outside.
    int add_texture(const Image& image, const std::string& name, bool repeats, std::span<const float> opacity = {});

    /// Return the bytes of a GLB file, or JSON with an embedded buffer. glb() throws InputError if a file exceeds 4
    /// GiB.
    std::string glb() const;
    std::string gltf() const;

  private:
    int add_accessor(const char* type, int component_type, std::size_t count, std::string_view bytes, int target);
    Json complete(bool with_data) const;

    std::string buffer_;
};

}  // namespace interflect::detail
