#pragma once

#include <optional>

namespace interflect::detail {

/// Returns the number of processes that a launcher (mpirun, srun, mpiexec) started together, 0 if the launcher does not
/// say, or nothing for a process that was started alone. Reads the environment.
std::optional<int> launched_processes();

}  // namespace interflect::detail
