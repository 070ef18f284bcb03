#include "interflect/exports/gltf/lit_gltf.h"

#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/gltf/gltf_lightmap.h"
#include "interflect/exports/gltf/gltf_vertex_light.h"

namespace interflect::detail {

namespace {

std::vector<ExportedFile> make(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                               const ExportOptions& options, std::string (GltfDocument::*encode)() const) {
    GltfDocument document;
    std::vector<ExportedFile> files;
    if (options.lightmap)
        files = add_lightmap(document, path, scene, solution, options);
    else
        add_vertex_light(document, scene, solution, options);
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
