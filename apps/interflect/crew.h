#pragma once

#include <exception>
#include <filesystem>

#include "interflect/core.h"
#include "interflect/solver.h"

namespace interflect::command {

enum class Role {
    first,   ///< Reads the command line and writes all files and messages; or this process is alone.
    helper,  ///< Only helps to solve, and ignores signals that ask for an end.
    refused  ///< The processes differ, so their bits would too; the first has reported this.
};

/// Joins the processes that mpirun started. They end together if one is lost.
/// @throws std::runtime_error as join_ranks(), in the first process.
Role join_crew();

/// Helps to solve the runs of the first process until dismiss_crew(). @throws the exceptions of Solver.
void serve_crew();

/// The first process calls this at its end, also after an error outside runs.
void dismiss_crew();

/// Reports the error of this process in a run and ends all processes. No effect without other processes.
void end_crew_after_fault(const std::exception& error);

/// A run that the whole crew solves. Without a crew it is the Solver alone.
class CrewRun {
  public:
    /// Sends the run to the others. The solver must outlive this.
    /// @param checkpoint  File into which the run is saved between calls of advance(), or empty.
    CrewRun(Solver& solver, std::filesystem::path checkpoint);
    ~CrewRun();
    CrewRun(const CrewRun&) = delete;
    CrewRun& operator=(const CrewRun&) = delete;

    AdvanceReport advance(const Limits& limits, Monitor monitor);
    void set_plan(const Limits& limits);

  private:
    Solver& solver_;
    std::filesystem::path checkpoint_;
    bool has_advanced_ = false;
};

}  // namespace interflect::command
