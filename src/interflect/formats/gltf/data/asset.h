#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "interflect/formats/build/model.h"
#include "interflect/formats/gltf/data/value.h"
#include "interflect/load.h"

namespace interflect::detail {

/// The chunks of a GLB file. A .gltf file consists only of JSON.
struct GltfParts {
    std::string_view json, binary;
    bool is_binary = false;
};

/// @throws GltfFault for an invalid GLB.
GltfParts gltf_parts(std::string_view bytes);

/// A glTF file, and the model that is read from it.
class GltfAsset {
  public:
    GltfAsset(const std::filesystem::path& path, const ReadOptions& options, const nlohmann::json& json);

    const GltfValue& root() const { return root_; }
    const ReadOptions& options() const { return options_; }
    const std::filesystem::path& path() const { return model.file; }

    void warn(const char* kind, const std::string& message, const std::string& place);

    /// Returns whether a URI names a file that does not exist, in the scene's folder.
    bool is_missing(const std::string& uri, const GltfValue& owner) const;
    /// Reads a data URI, or a file in the scene's folder.
    std::string read_uri(const std::string& uri, const GltfValue& owner);
    /// Counts bytes that are read or decoded. @throws GltfFault beyond max_model_bytes in total.
    void count_bytes(std::uint64_t count, const GltfValue& owner);

    Model model;

  private:
    /// Returns the file that a URI names. @throws GltfFault unless it may be read.
    std::filesystem::path file_of(const std::string& uri, const GltfValue& owner) const;
    std::string read_file(const std::string& uri, const GltfValue& owner);

    GltfValue root_;
    const ReadOptions& options_;
    std::uint64_t counted_bytes_ = 0;
};

}  // namespace interflect::detail
