#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "interflect/path_tracer.h"

namespace interflect::command {

/// Where the help lists them.
inline constexpr const char* path_group = "Path tracing";

/// What `render --shading path` alone takes.
struct PathTracerArguments {
    int max_samples = PathOptions().max_samples;
    std::filesystem::path error_image;  ///< Empty: none.

    void add_to(CLI::App& app);
};

/// Traces paths with a progress bar, says what came of it, and writes the image of the standard error if asked for.
/// Ctrl-C ends it early with what there is.
PathTracing run_path_tracer(const Scene& scene, const RayCaster& ray_caster, const View& view, PathOptions options,
                            const PathTracerArguments& arguments);

}  // namespace interflect::command
