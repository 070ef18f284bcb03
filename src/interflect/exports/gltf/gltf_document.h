#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interflect/core.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/image.h"
#include "interflect/scene.h"

namespace interflect::detail {

class GltfDocument {
  public:
    GltfDocument();

    /// Excludes the buffer.
    Json json;

    /// Appends to an array such as "materials"; returns the index.
    int add(const char* array, Json object);
    void use_extension(const char* name);

    /// Return accessor indices.
    int add_positions(std::span<const V3f> values);  ///< Adds bounds, which glTF requires.
    int add_attribute(std::span<const Rgb> values);
    int add_attribute(std::span<const V2f> values);
    int add_indices(std::span<const std::uint32_t> values);

    /// Adds a texture as 8-bit sRGB PNG, clamped to [0, 1]; returns its index.
    /// @param opacity  Alpha in [0, 1]; empty: no alpha channel.
    /// @param repeats  With mipmaps; otherwise extends edge texels.
    int add_texture(const Image& image, const std::string& name, bool repeats, std::span<const float> opacity = {});

    /// Return GLB, or JSON with embedded buffer. glb() throws InputError beyond 4 GiB.
    std::string glb() const;
    std::string gltf() const;

  private:
    int add_accessor(const char* type, int component_type, std::size_t count, std::string_view bytes, int target);
    int add_buffer_view(std::string_view bytes);
    Json complete(bool with_data) const;

    std::string buffer_;
};

}  // namespace interflect::detail
