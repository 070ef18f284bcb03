#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/measure.h"
#include "interflect/scene.h"

namespace interflect::command {

struct GridArguments {
    std::optional<double> spacing;  ///< [m]
    std::string boundary;           ///< [m]; may be empty.

    void add_to(CLI::App& app);
    bool any() const { return spacing || !boundary.empty(); }
    GridOptions options() const;
};

/// Places that `probe` measures.
struct MeasuringPlaces {
    std::vector<std::string> tops, surfaces;  ///< Objects whose tops or planar surfaces are measured.
    std::optional<V3f> facing;                ///< Side from which surfaces are measured, if it is ambiguous.
    std::vector<double> planes;               ///< Heights z of horizontal grids [m].
    std::string over;                         ///< Object below the planes; empty for the floor.
    std::vector<Imath::V3d> points;
    std::vector<Line> lines;
    GridArguments grid;
    bool whole_objects = false;  ///< Whether the boundary strip is for planes, but not for tops and surfaces.

    void add_to(CLI::App& app);
    enum class Least { none, one };
    /// @throws UsageError for too few places and for options without effect.
    void check(Least least = Least::one) const;
    /// Returns a grid for each place; single points share a grid. @throws InputError as find_surface() and area_grid()
    /// do.
    std::vector<MeasuringGrid> grids(const Scene& scene) const;
};

/// Returns the grids without their points inside furniture.
std::vector<MeasuringGrid> open_grids(const Scene& scene, const RayCaster& ray_caster,
                                      std::vector<MeasuringGrid> grids);

/// Returns "35 points, 7 x 5, 0.2 x 0.19 m apart, without 2 inside furniture".
std::string text_of(const MeasuringGrid& grid);

}  // namespace interflect::command
