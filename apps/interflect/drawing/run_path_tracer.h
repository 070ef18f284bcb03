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

    /// @param picture  Receives the options of interflect::render().
    void add_to(CLI::App& app, PictureOptions& picture);
    /// @throws UsageError for an error image in an 8-bit format, and as require_denoiser() does.
    void check() const;
    /// @param samples  Number of paths per pixel or measuring point. The error is estimated from their variance.
    /// @throws UsageError for fewer than two samples, for --max-samples below `samples`, and for --max-samples without
    ///         --until.
    static void check_samples(const CLI::App& app, int samples);
    /// Whether the output contains results of path tracing other than the picture.
    bool has_path_outputs() const { return layers || !error_image.empty(); }
};

/// Whether each pixel has two batches of paths, the fewest that give its light and error.
bool has_every_pixel(const Rendering& traced);

/// Returns the layers of an OpenEXR file. They refer to the values in `traced`.
std::vector<ImageLayer> layers_of(const Rendering& traced);

/// @throws std::runtime_error if a gathered or path-traced picture does not fit into memory.
void require_memory_for_paths(Size size);

/// A picture drawn by paths.
struct TracedPicture : Rendering {
    std::string filter;  ///< DenoisedPicture::filter; empty if noise is not filtered.
};

/// Traces paths with a progress bar, filters noise, logs the outcome and writes the error image, as requested. Ctrl-C
/// ends it early with fewer samples.
///
/// If a pixel then has fewer than two batches, the caller can draw the solution in another way. The picture is
/// therefore returned unfiltered and is not logged, unless PathTracerArguments::has_path_outputs() or the solution is
/// missing.
/// @param solution    Null for shading without a solution.
/// @param on_picture  Receives pictures during the work (Monitor::on_picture), filtered like the final one. May be
///                    empty.
TracedPicture run_path_tracer(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                              const View& view, const PictureOptions& options, const PathTracerArguments& arguments,
                              const std::function<void(const Image&)>& on_picture = {});

}  // namespace interflect::command
