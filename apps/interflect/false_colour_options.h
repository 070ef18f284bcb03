#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/image.h"

namespace interflect::command {

/// Quantity shown in false colours.
enum class Measured {
    illuminance,  ///< Of visible surfaces [lx].
    luminance,    ///< Of the picture [cd/m^2].
};

/// False colours of `render`.
struct FalseColourOptions {
    std::optional<Measured> measured;  ///< Empty: natural colours.
    std::optional<Range> scale;
    bool logarithmic = false;
    std::optional<std::vector<float>> isolines;  ///< If empty, round values.

    void add_to(CLI::App& app);
    /// @throws UsageError for options that have no effect or contradict each other.
    void check() const;
    /// Returns the name and unit for a legend and metadata.
    std::string label() const;
    /// Draws values in false colours, with a legend below if wanted.
    /// @param values  Measured numbers in the first channel.
    Image draw(const Image& values, bool has_legend) const;
};

/// Returns the luminance of each pixel, in all channels.
Image luminances(const Image& light);

}  // namespace interflect::command
