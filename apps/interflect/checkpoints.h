#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "interflect/solver.h"

namespace interflect::command {

struct Checkpoints {
    std::filesystem::path file;  ///< Empty: no checkpoints.
    double every = 60;           ///< [s]

    /// @param what  Help text of --checkpoint.
    void add_to(CLI::App& app, const std::string& what);
    /// Must precede long work. @throws InputError if the file cannot be written.
    void require_writable() const;
    /// Saves the run and keeps the last checkpoint as NAME.previous.h5. Failures only log a warning.
    void save(Solver& solver) const;
};

}  // namespace interflect::command
