#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include "interflect/core.h"
#include "interflect/solver.h"

namespace interflect::command {

enum class Role {
    first,   ///< Reads the command line and writes all files and messages; or this process is alone.
    other,   ///< Only traces its share, and ignores signals that ask for an end.
    refused  ///< The processes differ, so their bits would too; the first has reported this.
};

/// Joins the processes that mpirun started. They end together if one is lost.
/// @throws std::runtime_error as join_ranks(), in the first process.
Role connect_ranks();

/// Helps the first process with its runs, and with its light (SharedLight), until dismiss_ranks(). @throws the
/// exceptions of Solver, of read_solution() and of drawing.
void serve_first_rank();

/// The first process calls this at its end, also after an error outside runs.
void dismiss_ranks();

/// Reports the error of this process in shared work and ends all processes. No effect without other processes.
void end_ranks_after_fault(const std::exception& error, int exit_code);

/// Makes the others call share_light() with a solution. Must not be called during SharedRun::advance().
/// @param make_image  Returns the solution as solution_image().
/// @return            Null without other processes.
Ranks* start_shared_light(const std::function<std::string()>& make_image);

/// A run that all ranks solve. Without other ranks it is the Solver alone.
class SharedRun {
  public:
    /// Sends the run to the others. The solver must outlive this.
    /// @param checkpoint  File into which the run is saved between calls of advance(), or empty.
    SharedRun(Solver& solver, std::filesystem::path checkpoint);
    ~SharedRun();
    SharedRun(const SharedRun&) = delete;
    SharedRun& operator=(const SharedRun&) = delete;

    AdvanceReport advance(const Limits& limits, Monitor monitor);
    void set_plan(const Limits& limits);

  private:
    Solver& solver_;
    std::filesystem::path checkpoint_;
    bool has_advanced_ = false;
};

}  // namespace interflect::command
