#pragma once

#include <optional>

namespace interflect::detail {

/// Returns the number of processes of a launcher (mpirun, srun, mpiexec), 0 if it is unknown. Empty without a launcher.
/// Reads the environment.
std::optional<int> launched_processes();

}  // namespace interflect::detail
