// Whatever bytes come in: the MGF reader returns a valid scene or throws an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "interflect/error.h"
#include "interflect/formats/mgf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    interflect::ReadOptions options;
    options.curve_divisions = 2;
    options.max_patches = 10'000;
    options.max_include_depth = 0;  // the outcome depends on these bytes alone
    options.max_face_vertices = 64;
    try {
        const interflect::Scene scene =
            interflect::read_mgf_text({reinterpret_cast<const char*>(data), size}, "fuzz.mgf", options);
        for (const std::string& fault : interflect::scene_faults(scene)) {
            std::fprintf(stderr, "%s\n", fault.c_str());
            std::abort();
        }
        if (scene.patches.size() > options.max_patches + 2 * options.max_face_vertices * options.max_face_vertices)
            std::abort();
    } catch (const interflect::InputError&) {
    }
    return 0;
}
