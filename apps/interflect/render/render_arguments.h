#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <string>

#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/drawing/show.h"
#include "apps/interflect/options/cut_options.h"
#include "apps/interflect/options/false_colour_options.h"
#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/image.h"
#include "interflect/render.h"

namespace interflect::command {

/// Options of the command `render`.
struct RenderArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    CutOptions section;  ///< Floor plan or section.
    DimmingOptions dimming;
    SolverOptions solver;
    PathTracerArguments path;  ///< complete_options() sets the default denoiser.
    std::filesystem::path output;
    Size size;  ///< Size of the written picture, including its legend.
    /// Options of interflect::render(). complete_options() sets its size, quantity, target and seed, and the defaults
    /// of shading and samples.
    PictureOptions picture;
    Exposure exposure;
    Tonemap tonemap = Tonemap::srgb;
    float display_luminance = usual_display_luminance;  ///< [cd/m^2]
    Shown shown = Shown::light;
    FalseColourOptions false_colour;
    bool progressive = false;  ///< Whether better pictures replace the first as the light improves.

    // Set by complete_options().
    int legend_rows = 0;              ///< Height of the legend below the view [pixels]; 0 for no legend.
    bool has_default_samples = true;  ///< Whether --samples is not given.

    void add_to(CLI::App& command);

    /// Whether the output has 8-bit values for display (.png, .jpg). Other formats contain light or numbers.
    bool is_for_display() const;
    /// Whether the picture shows numbers instead of colours of light.
    bool shows_numbers() const { return is_quantity(shown) || false_colour.measured; }
    /// Returns the name and unit of the numbers, if shows_numbers().
    std::string label_of_numbers() const;
    /// Height of the view, without the legend [pixels].
    int view_rows() const { return size.height - legend_rows; }
    /// Width over height of the written picture.
    float aspect() const { return static_cast<float>(size.width) / static_cast<float>(size.height); }
    std::array<NamedFile, 3> outputs() const;
    bool has_time_limit() const;
    /// Time until the limit of --time for the whole command [s]: infinite without --time, negative after the limit.
    double seconds_left() const;

  private:
    void add_picture_to(CLI::App& command);
    void add_tone_to(CLI::App& command);
};

}  // namespace interflect::command
