#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

struct LightGroupOptions {
    bool by_name = false;
    std::vector<LightGroup> groups;

    void add_to(CLI::App& app);
    /// @throws UsageError for two groups of one name and for too many.
    void check() const;
    /// @throws InputError for a group without sources.
    void set_groups(Scene& scene) const;
};

struct DimmingOptions {
    std::vector<Dimmed> factors;

    void add_to(CLI::App& app);
    /// @throws InputError for an unknown group; the message lists the groups.
    void dim(SolvedScene& solved) const;
    /// @throws UsageError if groups are dimmed but `scene` is not a solution.
    void require_solution(const std::filesystem::path& scene) const;
};

}  // namespace interflect::command
