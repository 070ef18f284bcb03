// For arbitrary bytes that are a scene, the lightmap is added to them, or an error is thrown; the scene is the same
// afterwards.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "interflect/core.h"
#include "interflect/exports/authored/patched_gltf.h"
#include "interflect/formats/gltf/gltf.h"
#include "tests/exports/lightmap/lightmaps.h"

using namespace interflect;
using namespace interflect::detail;

namespace {

constexpr const char* path = "fuzz.glb";

ReadOptions limits() {
    ReadOptions options;
    options.max_patches = 200;
    options.max_include_depth = 0;  // reads no other files
    options.max_model_bytes = 1 << 22;
    return options;
}

std::string lit(const std::string& bytes, const Scene& scene) {
    ExportOptions options = lightmap_testing::at(1);
    options.lightmap->max_size = 64;
    options.lightmap->max_bytes = 1 << 26;
    SourceGltf source(path, bytes, limits());
    GltfDocument document = source.document();
    add_lightmap(document, source, path, scene, lightmap_testing::uniform(scene, 1), options, /*earlier=*/nullptr);
    return document.glb();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    std::string added;
    Scene scene;
    try {
        scene = read_gltf_bytes(bytes, path, limits());
        added = lit(bytes, scene);
    } catch (const InputError&) {
        return 0;
    } catch (const GltfFault&) {
        return 0;
    } catch (const nlohmann::json::exception&) {
        return 0;
    }
    const Scene again = read_gltf_bytes(added, path, limits());
    if (again.patches.size() == scene.patches.size()) return 0;
    std::fprintf(stderr, "%zu patches, %zu with light\n", scene.patches.size(), again.patches.size());
    std::abort();
}
