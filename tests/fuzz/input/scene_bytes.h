#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "interflect/core.h"
#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::fuzzing {

/// Options for small scenes and short times; the result depends on the bytes alone.
inline ReadOptions options() {
    ReadOptions options;
    options.curve_divisions = 2;
    options.max_patches = 10'000;
    options.max_include_depth = 0;
    options.max_face_vertices = 64;
    return options;
}

/// Stops the program unless `read` returns a valid scene within the limits or throws an InputError.
template <class Read>
int require_scene_or_error(const Read& read) {
    try {
        const Scene scene = read(options());
        for (const Fault& fault : scene_faults(scene)) {
            std::fprintf(stderr, "%s\n", fault.text.c_str());
            std::abort();
        }
        if (scene.patches.size() >
            options().max_patches + 2 * options().max_face_vertices * options().max_face_vertices)
            std::abort();
    } catch (const InputError&) {
    }
    return 0;
}

}  // namespace interflect::fuzzing
