#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Plans and sections: orthographic pictures of the scene cut open, to scale.
struct CutOptions {
    std::optional<double> plan;        ///< Height of the cut [m].
    std::optional<Section> section;    ///< Another cut.
    std::optional<double> extent;      ///< From the top of the picture to its bottom [m]; none: all of the scene.
    std::optional<Imath::V3d> centre;  ///< Of the picture, moved onto the cut; none: the scene's.

    /// @param others  Options that name a view in another way.
    void add_to(CLI::App& app, const std::vector<std::string>& others);
    bool is_given() const { return plan || section; }
    /// @throws UsageError for options without a cut.
    void check() const;
    /// Logs the picture's scale.
    View view(const Scene& scene, int columns, int rows) const;
};

}  // namespace interflect::command
