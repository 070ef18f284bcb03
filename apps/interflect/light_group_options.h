#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/scene.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// Which sources of light are kept apart.
struct LightGroupOptions {
    bool by_name = false;
    std::vector<LightGroup> groups;

    void add_to(CLI::App& app);
    /// Gives the scene its groups. @throws InputError for one that no source is in.
    void set_groups(Scene& scene) const;
};

/// How light groups are dimmed.
struct DimmingOptions {
    std::vector<Dimmed> factors;

    void add_to(CLI::App& app);
    /// @throws InputError that lists the groups, for a group that the solution does not have.
    void dim(SolvedScene& solved) const;
    /// @throws UsageError where groups are dimmed, but `scene` is no solution.
    void require_solution(const std::filesystem::path& scene) const;
};

}  // namespace interflect::command
