#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/denoise.h"
#include "interflect/image.h"
#include "interflect/render.h"
#include "interflect/solve.h"

namespace interflect::command {

inline constexpr const char* path_group = "Gathering and path tracing";

/// Options of `render` for shading by paths.
struct PathTracerArguments {
    std::filesystem::path error_image;  ///< File of the error image; empty for no image.
    std::optional<Denoiser> denoise;    ///< Empty: off.
    bool layers = false;

    /// @param picture  Receives the options of the library.
    void add_to(CLI::App& app, PictureOptions& picture);
    /// @throws UsageError for an error image in an 8-bit format.
    void check() const;
    /// @throws UsageError for fewer than two --samples, whose variance gives the error, and for --max-samples below
    /// that or without --until.
    static void check_samples(const CLI::App& app, int samples);
    /// Whether the output contains results of path tracing other than the picture.
    bool has_path_outputs() const { return layers || !error_image.empty(); }
};

/// Whether each pixel has two batches of paths.
bool has_every_pixel(const Rendering& traced);

/// Returns the layers of an OpenEXR file; refers to `traced`.
std::vector<ImageLayer> layers_of(const Rendering& traced);

/// @throws std::runtime_error if a gathered or path-traced picture does not fit into memory.
void require_memory_for_paths(Size size);

/// A picture drawn by paths.
struct TracedPicture : Rendering {
    std::string filter;  ///< DenoisedPicture::filter; empty: none.
};

/// Traces paths with a progress bar, logs the outcome, and writes the error image if requested. Ctrl-C ends it early
/// with a partial result, which is neither filtered nor reported if smooth shading can replace it.
/// @param solution    Null for shading without a solution.
/// @param on_picture  Receives the picture so far (Monitor::on_picture), filtered as the last. May be empty.
TracedPicture run_path_tracer(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                              const View& view, const PictureOptions& options, const PathTracerArguments& arguments,
                              const std::function<void(const Image&)>& on_picture = {});

}  // namespace interflect::command
