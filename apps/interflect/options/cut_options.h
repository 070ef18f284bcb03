#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/scene.h"

namespace interflect::command {

/// Plans and sections: orthographic pictures of the scene cut open.
struct CutOptions {
    std::optional<double> plan;  ///< Height of the cut [m].
    std::optional<Section> section;
    std::optional<double> extent;      ///< Height of the picture [m], by default of the whole scene.
    std::optional<Imath::V3d> centre;  ///< Centre of the picture, moved onto the cut; default: the scene's.

    /// @param others  Options that exclude a cut.
    void add_to(CLI::App& app, const std::vector<std::string>& others);
    bool is_given() const { return plan || section; }
    /// @throws UsageError for options that need a cut, without one.
    void check() const;
    /// Returns the view and logs the picture's scale.
    View view(const Scene& scene, int columns, int rows) const;
};

}  // namespace interflect::command
