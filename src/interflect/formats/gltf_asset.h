#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "interflect/formats/gltf_value.h"
#include "interflect/formats/model.h"
#include "interflect/read_options.h"

namespace interflect::inline detail {

/// The two parts of a GLB file, or a .gltf file, which is all JSON.
struct GltfParts {
    std::string_view json, binary;
    bool is_binary = false;  ///< Whether the file is a GLB with a binary chunk.
};

/// @throws GltfFault for a GLB that is cut short or of another version.
GltfParts gltf_parts(std::string_view bytes);

/// What the readers of a glTF file's parts share: its JSON, the files that it names, the model that it fills.
class GltfAsset {
  public:
    GltfAsset(const std::filesystem::path& path, const ReadOptions& options, const nlohmann::json& json);

    const GltfValue& root() const { return root_; }
    const ReadOptions& options() const { return options_; }
    const std::filesystem::path& path() const { return model.file; }

    void warn(const char* kind, const std::string& message, const std::string& place);

    /// The bytes that a URI stands for: data, or a file in the folder of this one.
    /// @param user  Named in errors.
    std::string read_uri(const std::string& uri, const GltfValue& user);
    /// Counts memory that the file asks for. @throws GltfFault where that is more than options.max_model_bytes.
    void take_bytes(std::uint64_t count, const GltfValue& user);

    Model model;

  private:
    std::string read_file(const std::string& uri, const GltfValue& user);

    GltfValue root_;
    const ReadOptions& options_;
    std::uint64_t taken_ = 0;
};

}  // namespace interflect::inline detail
