#include "interflect/exports/lit_gltf.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "interflect/exports/authored/patched_gltf.h"
#include "interflect/exports/authored/source_gltf.h"
#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/gltf/gltf_lightmap.h"
#include "interflect/exports/gltf/gltf_vertex_light.h"

namespace interflect::detail {

namespace {

/// Returns the glTF file to which a lightmap is added; null if the scene is written anew.
std::unique_ptr<SourceGltf> kept_file(const Scene& scene, const std::filesystem::path& folder,
                                      const ExportOptions& options) {
    if (!options.lightmap || !options.lightmap->keep_file) return nullptr;
    Warnings ignored;
    return source_of(scene, folder, options.warnings ? *options.warnings : ignored);
}

/// @param encode  GltfDocument::glb or GltfDocument::gltf.
std::vector<ExportedFile> make(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                               const ExportOptions& options, std::string (GltfDocument::*encode)() const) {
    GltfDocument document;
    std::vector<ExportedFile> files;
    std::optional<EarlierLightmap> read;
    if (options.lightmap && !options.lightmap->update.empty())
        read = read_earlier_lightmap(path, *options.lightmap, solution.group_names);
    const EarlierLightmap* const earlier = read ? &*read : nullptr;
    if (const std::unique_ptr<SourceGltf> source = kept_file(scene, path.parent_path(), options)) {
        try {
            document = source->document();
            files = add_lightmap(document, *source, path, scene, solution, options, earlier);
        } catch (const nlohmann::json::exception& fault) {  // a fault in a part that the scene reader skips
            throw InputError(scene.files.front(), 0, fmt::format("no valid glTF: {}", fault.what()));
        } catch (const GltfFault& fault) {
            throw InputError(scene.files.front(), 0, fault.what());
        }
    } else if (options.lightmap) {
        files = add_lightmap(document, path, scene, solution, options, earlier);
    } else {
        add_vertex_light(document, scene, solution, options);
    }
    files.push_back({path, (document.*encode)()});
    return files;
}

}  // namespace

std::vector<ExportedFile> make_glb(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options) {
    return make(path, scene, solution, options, &GltfDocument::glb);
}

std::vector<ExportedFile> make_gltf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                    const ExportOptions& options) {
    return make(path, scene, solution, options, &GltfDocument::gltf);
}

}  // namespace interflect::detail
