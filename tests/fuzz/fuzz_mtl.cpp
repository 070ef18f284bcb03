// Whatever bytes come in: a material library gives a valid material or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "interflect/formats/obj_materials.h"
#include "tests/fuzz/scene_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return interflect::fuzzing::require_scene_or_error([&](const interflect::ReadOptions& options) {
        interflect::Model model;
        model.file = "fuzz.obj";
        interflect::ObjMaterials materials(model, options);
        materials.read_text(bytes, "fuzz.mtl");
        model.meshes.push_back(
            {"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}, {}, 0, true});
        model.meshes[0].material = materials.find("a", {&model.file, 1});
        model.instances.push_back({});
        return interflect::scene_of(std::move(model), options);
    });
}
