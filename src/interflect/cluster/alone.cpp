#include <fmt/format.h>

#include <stdexcept>

#include "interflect/cluster/launcher.h"
#include "interflect/ranks.h"

namespace interflect {

std::shared_ptr<Ranks> join_ranks(const FaultReport&) {
    const std::optional<int> count = detail::launched_processes();
    if (!count || *count == 1) return nullptr;
    throw std::runtime_error(
        fmt::format("this Interflect was built without MPI, so {} processes would all do the same: build it with "
                    "-DINTERFLECT_MPI=ON, or start it without mpirun or srun",
                    *count == 0 ? std::string("several") : std::to_string(*count)));
}

}  // namespace interflect
