// For arbitrary bytes, the glTF reader returns a valid scene or throws an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "interflect/core.h"
#include "interflect/formats/gltf/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    interflect::ReadOptions options;
    options.max_patches = 10'000;
    options.max_include_depth = 0;  // reads no other files
    options.max_model_bytes = 1 << 22;
    try {
        const interflect::Scene scene =
            interflect::detail::read_gltf_bytes({reinterpret_cast<const char*>(data), size}, "fuzz.glb", options);
        for (const interflect::Fault& fault : interflect::scene_faults(scene)) {
            std::fprintf(stderr, "%s\n", fault.text.c_str());
            std::abort();
        }
    } catch (const interflect::InputError&) {
    }
    return 0;
}
