#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "apps/interflect/parse.h"
#include "interflect/image.h"
#include "interflect/render.h"
#include "interflect/solve.h"

namespace interflect::command {

inline constexpr const char* path_group = "Gathering and path tracing";

/// Options of `render` for shading by paths.
struct PathTracerArguments {
    int max_samples = PathOptions().max_samples;
    std::filesystem::path error_image;  ///< Empty: no image.
    bool denoise = false;
    bool layers = false;
    bool mirrors = true;

    void add_to(CLI::App& app);
    /// @throws UsageError for an error image in an 8-bit format.
    void check() const;
    /// @throws UsageError for fewer than two --samples, whose variance gives the error, and for --max-samples below
    /// that or without --until.
    static void check_samples(const CLI::App& app, int samples);
    bool needs_paths() const { return layers || !error_image.empty(); }
};

/// Whether each pixel has two batches of paths.
bool has_every_pixel(const PathTracing& traced);

/// Returns the layers of an OpenEXR file; refers to `traced`.
std::vector<ImageLayer> layers_of(const PathTracing& traced);

/// A way to draw by paths.
struct PathShading {
    std::string name;
    std::function<PathTracing(const PathOptions&, const Monitor&)> draw;
    const Solution* solution;  ///< Smooth shading of it can replace the picture; null: drawn without a solution.
    std::size_t memory = 0;    ///< Of virtual lights [bytes].
};

/// @throws std::runtime_error if a gathered or path-traced picture does not fit into memory.
void require_memory_for_paths(Size size);

/// gather() or render_hybrid().
using Tracer = PathTracing (*)(const Scene&, const Solution&, const RayCaster&, const View&, const PathOptions&,
                               const Monitor&);

/// Traces paths with a progress bar, logs the outcome, and writes the error image if requested. Ctrl-C ends it early
/// with a partial result, which is neither filtered nor reported if smooth shading can replace it.
PathTracing run_path_tracer(const Scene& scene, const PathShading& shading, const View& view, PathOptions options,
                            const PathTracerArguments& arguments);

}  // namespace interflect::command
