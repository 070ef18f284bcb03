#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "interflect/solver.h"

namespace interflect::command {

/// Where the state of a run is saved while it goes on, so that `resume` can go on with it.
struct Checkpoints {
    std::filesystem::path file;  ///< Empty: nowhere.
    double every = 60;           ///< [s]

    /// @param what  Said of the file.
    void add_to(CLI::App& app, const std::string& what);
    /// To be called before long work begins. @throws InputError where the file cannot be written.
    void require_writable() const;
    /// Saves the run; the last checkpoint is kept beside it as NAME.previous.h5. Where that fails a warning is logged,
    /// and the run goes on.
    void save(Solver& solver) const;
};

}  // namespace interflect::command
