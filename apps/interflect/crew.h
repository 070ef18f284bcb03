#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "interflect/core.h"
#include "interflect/ranks.h"
#include "interflect/solver.h"

namespace interflect::command {

/// Joins the processes that mpirun started. The first one reads the command line and writes all files and messages; the
/// others only help to solve.
/// @return  Whether this process is the first, or alone.
/// @throws std::runtime_error if the processes run different builds or have different instructions, and would not have
/// the same bits.
bool join_crew();

/// Helps the first process with its runs, and with its light (CrewLight), until dismiss_crew(). @throws the exceptions
/// of Solver, of read_solution() and of drawing.
void serve_crew();

/// The first process calls this at its end, also after an error outside runs.
void dismiss_crew();

/// Ends all processes with this exit code, after an error in a run. No effect without other processes.
void abort_crew(int exit_code);

/// Makes the others call help_with_light() with a solution file. Not while a CrewRun works.
/// @param write  Writes the file.
/// @return       Null without other processes.
Ranks* start_light_help(const std::function<void(const std::filesystem::path&)>& write);

/// A run that the whole crew solves. Without a crew it is the Solver alone.
class CrewRun {
  public:
    /// Sends the run to the others. The solver must outlive this.
    explicit CrewRun(Solver& solver);
    ~CrewRun();
    CrewRun(const CrewRun&) = delete;
    CrewRun& operator=(const CrewRun&) = delete;

    AdvanceReport advance(const Limits& limits, Monitor monitor);
    void set_plan(const Limits& limits);

  private:
    Solver& solver_;
};

}  // namespace interflect::command
