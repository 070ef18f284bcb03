#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/formats/build/model.h"
#include "interflect/formats/gltf/data/accessors.h"
#include "interflect/formats/gltf/parts/draco.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// The glTF file that a scene was read from.
class SourceGltf {
  public:
    /// @throws InputError, GltfFault
    SourceGltf(const std::filesystem::path& path, std::string bytes, const ReadOptions& options = {});

    const Model& model() const { return model_; }
    /// Returns the file with its buffers and the images of other files joined into the first buffer.
    GltfDocument document();
    /// Returns the values of an accessor of vertices.
    GltfElements elements(std::uint32_t accessor);
    /// Decompresses the attributes of a primitive with KHR_draco_mesh_compression, in single precision.
    std::map<std::string, DracoAttribute> decompressed(std::uint32_t mesh, std::uint32_t primitive);

  private:
    std::string bytes_;
    GltfParts parts_;
    nlohmann::json json_;
    ReadOptions options_;
    Model model_;
    GltfAsset asset_;
    GltfBuffers buffers_;
    GltfAccessors accessors_;
};

/// Returns the glTF file of a scene, at its path or else in `folder`. Null, with a warning about the reason, if the
/// file has changed since, is missing or was read in another unit or with another up axis; null without one for scenes
/// of other formats.
std::unique_ptr<SourceGltf> source_of(const Scene& scene, const std::filesystem::path& folder, Warnings& warnings);

}  // namespace interflect::detail
