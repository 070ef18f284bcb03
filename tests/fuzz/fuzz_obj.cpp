// For arbitrary bytes, the OBJ reader returns a valid scene or throws an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "interflect/formats/mesh/obj/obj.h"
#include "tests/fuzz/input/scene_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return interflect::fuzzing::require_scene_or_error([&](const interflect::ReadOptions& options) {
        return interflect::detail::read_obj_text(bytes, "fuzz.obj", options);
    });
}
