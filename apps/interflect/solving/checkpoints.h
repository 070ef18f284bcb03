#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "interflect/scene.h"
#include "interflect/solver.h"

namespace interflect::command {

struct Checkpoints {
    std::filesystem::path file;  ///< Empty: no checkpoints.
    double every = 60;           ///< [s]

    /// @param what  Help text of --checkpoint.
    void add_to(CLI::App& app, const std::string& what);
    /// NAME.previous.h5, which keeps the last checkpoint but one; empty without checkpoints.
    std::filesystem::path previous() const;
    /// Must precede long work. @throws InputError if the file cannot be written.
    void require_writable() const;
    /// @throws UsageError if previous() exists and is no saved run of the scene, because saving would replace it.
    void require_own_previous(const Scene& scene);
    /// Saves the run and keeps the last checkpoint of this scene as previous(). Failures only log a warning.
    void save(Solver& solver);

  private:
    bool replaces_other_ = false;  // `file` is no saved run of this scene
};

}  // namespace interflect::command
