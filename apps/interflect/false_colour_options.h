#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/image.h"

namespace interflect::command {

/// What false colours measure.
enum class Measured {
    illuminance,  ///< On the surfaces that are seen [lx].
    luminance,    ///< Of the picture [cd/m^2].
};

/// How `render` draws what it measured.
struct FalseColourOptions {
    std::optional<Measured> measured;  ///< None: colours as they are.
    std::optional<Range> scale;
    bool logarithmic = false;
    std::optional<std::vector<float>> isolines;  ///< Values; none in it: round ones.

    void add_to(CLI::App& app);
    /// @throws UsageError for options that have no effect, or contradict each other.
    void check() const;
    /// With the unit, for a legend and the metadata of a picture.
    std::string label() const;
    /// In false colours, with a legend below if it is to have one.
    /// @param values  Numbers as they were measured, in the first channel.
    Image draw(const Image& values, bool has_legend) const;
};

/// The numbers of a picture: its luminance, in all channels.
Image luminances(const Image& light);

}  // namespace interflect::command
