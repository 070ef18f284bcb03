#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interflect/colour.h"
#include "interflect/exports/json_text.h"
#include "interflect/image.h"
#include "interflect/texture.h"

namespace interflect::inline detail {

/// A glTF 2.0 file that is being written: its JSON, and the one buffer that everything binary is in.
class GltfDocument {
  public:
    GltfDocument();

    /// What else the file says; callers add to it. Its arrays have indices, see add().
    Json json;

    /// Adds an object to one of the arrays of the JSON, such as "materials". @return  Its index.
    int add(const char* array, Json object);
    /// Names an extension that the file uses.
    void use_extension(const char* name);

    /// Add an accessor of vertex attributes, or of a triangle list's indices. @return  Its index.
    int add_positions(std::span<const V3f> values);  ///< With bounds, which positions must have.
    int add_attribute(std::span<const Rgb> values);
    int add_attribute(std::span<const V2f> values);
    int add_indices(std::span<const std::uint32_t> values);

    /// Adds an image as PNG with 8 bit sRGB, and a texture that shows it; values are clamped to [0, 1].
    /// @param opacity  Of each pixel, in [0, 1], for the alpha channel; none: there is none.
    /// @param repeats  Whether it repeats beyond [0, 1]; else its edge goes on.
    /// @return         The texture's index.
    int add_texture(const Image& image, const std::string& name, bool repeats, std::span<const float> opacity = {});

    /// The file as GLB, or as JSON with the buffer within. @throws InputError beyond 4 GiB.
    std::string glb() const;
    std::string gltf() const;

  private:
    int add_accessor(const char* type, int component_type, std::size_t count, std::string_view bytes, int target);
    int add_buffer_view(std::string_view bytes);
    Json complete(bool with_data) const;

    std::string buffer_;
};

}  // namespace interflect::inline detail
