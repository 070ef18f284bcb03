#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "apps/interflect/parse.h"
#include "interflect/image_files.h"
#include "interflect/path_tracer.h"
#include "interflect/solve.h"

namespace interflect::command {

/// Where the help lists them.
inline constexpr const char* path_group = "Gathering and path tracing";

/// What `render --shading gather` and `path` alone take.
struct PathTracerArguments {
    int max_samples = PathOptions().max_samples;
    std::filesystem::path error_image;  ///< Empty: none.
    bool denoise = false;
    bool layers = false;
    bool mirrors = true;

    void add_to(CLI::App& app);
    /// @throws UsageError for an error image in a format of 8 bits.
    void check() const;
    /// @throws UsageError for fewer than two --samples, whose spread tells the error, and for --max-samples below these
    /// or without a target.
    static void check_samples(const CLI::App& app, int samples);
};

/// What else is known of the pixels, in the layers of an OpenEXR file; refers to `traced`.
std::vector<ImageLayer> layers_of(const PathTracing& traced);

/// @throws std::runtime_error if a gathered or path-traced picture does not fit into memory.
void require_memory_for_paths(Size size);

/// Traces paths with a progress bar, says what came of it, and writes the image of the standard error if asked for.
/// Ctrl-C ends it early with what there is.
/// @param solution  Final gathering from this; null: path tracing.
PathTracing run_path_tracer(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, const View& view,
                            PathOptions options, const PathTracerArguments& arguments);

}  // namespace interflect::command
