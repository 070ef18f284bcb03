// For arbitrary bytes, a material library gives a valid material or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "interflect/formats/mesh/obj/materials.h"
#include "tests/fuzz/input/scene_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return interflect::fuzzing::require_scene_or_error([&](const interflect::ReadOptions& options) {
        interflect::detail::Model model;
        model.file = "fuzz.obj";
        interflect::detail::ObjMaterials materials(model, options);
        materials.read_definitions(bytes, "fuzz.mtl");
        model.meshes.push_back({.name = "triangle",
                                .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                .texture_coordinates = {{0, 0}, {1, 0}, {0, 1}},
                                .lightmap_coordinates = {},
                                .indices = {0, 1, 2},
                                .face_sizes = {}});
        model.meshes[0].material = materials.index_of("a", {&model.file, 1});
        model.instances.push_back({});
        return interflect::detail::scene_of(std::move(model), options);
    });
}
