#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/image.h"

namespace interflect::command {

enum class Measured {
    illuminance,  ///< Illuminance of visible surfaces [lx].
    luminance,    ///< Luminance of pixels [cd/m^2].
};

struct FalseColourOptions {
    std::optional<Measured> measured;  ///< Quantity that is shown; nullopt for natural colours.
    std::optional<Range> scale;
    bool logarithmic = false;
    std::optional<std::vector<float>> isolines;  ///< Values of the isolines; round values if the list is empty.

    void add_to(CLI::App& app);
    /// @throws UsageError for options that have no effect or contradict each other.
    void check() const;
    /// Returns the quantity with its unit.
    std::string label() const;
    /// Draws false colours, with a legend below if wanted. @param values  Numbers in the first channel.
    Image draw(const Image& values, bool has_legend) const;
};

/// Returns the luminance in all channels.
Image luminances(const Image& light);

}  // namespace interflect::command
