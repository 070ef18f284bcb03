#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "interflect/scene.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// Which sources of light are kept apart.
struct LightGroupOptions {
    bool by_name = false;
    std::vector<std::string> groups;  ///< "name=pattern" each.

    void add_to(CLI::App& app);
    /// Gives the scene its groups. @throws InputError for one that no source is in.
    void set_groups(Scene& scene) const;
};

/// How light groups are dimmed.
struct DimmingOptions {
    std::vector<std::string> factors;  ///< "name=factor" each.

    void add_to(CLI::App& app);
    /// @throws InputError for a group that the solution does not have.
    void dim(SolvedScene& solved) const;
};

}  // namespace interflect::command
