#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/measuring_grid.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Spacing and boundary strip of measuring grids.
struct GridArguments {
    std::optional<double> spacing;  ///< [m]
    std::string boundary;           ///< [m]; empty: none.

    void add_to(CLI::App& app);
    bool any() const { return spacing || !boundary.empty(); }
    GridOptions options() const;
};

/// Where `probe` measures.
struct MeasuringPlaces {
    std::vector<std::string> tops, surfaces;
    std::optional<V3f> facing;  ///< Of the surfaces, where it is ambiguous.
    std::vector<double> planes;
    std::string over;  ///< What the planes lie over; empty: the floor.
    std::vector<Imath::V3d> points;
    std::vector<Line> lines;
    GridArguments grid;

    void add_to(CLI::App& app);
    /// How much there must be to measure.
    enum class Least { none, one };
    /// @throws UsageError where nothing can be measured, and for options without effect.
    void check(Least least = Least::one) const;
    /// A grid each; all points are one. @throws InputError as find_surface() and area_grid() do.
    std::vector<MeasuringGrid> grids(const Scene& scene) const;
};

/// "35 points, 7 x 5, 0.2 x 0.19 m apart".
std::string text_of(const MeasuringGrid& grid);

}  // namespace interflect::command
