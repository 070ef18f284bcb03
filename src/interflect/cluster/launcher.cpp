#include "interflect/cluster/launcher.h"

#include <charconv>
#include <cstdlib>
#include <initializer_list>
#include <string_view>

#include "interflect/ranks.h"

namespace interflect {

namespace {

// Open MPI's mpirun sets the first variable of each list, srun and mpiexec with PMI-1 or PMI-2 the second. PMIx has no
// variable for the count. srun also sets its own: SLURM_PROCID exists in batch scripts too, SLURM_STEP_NUM_TASKS only
// in processes of srun.
constexpr std::initializer_list<const char*> count_variables = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE",
                                                                "SLURM_STEP_NUM_TASKS"};
constexpr std::initializer_list<const char*> rank_variables = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};

/// Returns the first number among these variables.
std::optional<int> number_in(std::initializer_list<const char*> variables) {
    for (const char* name : variables) {
        const char* const value = std::getenv(name);
        if (!value) continue;
        const std::string_view text(value);
        int number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error == std::errc() && end == text.data() + text.size()) return number;
    }
    return std::nullopt;
}

}  // namespace

std::optional<int> detail::launched_processes() {
    if (const std::optional<int> count = number_in(count_variables)) return count;
    return launched_rank() ? std::optional(0) : std::nullopt;
}

std::optional<int> launched_rank() { return number_in(rank_variables); }

}  // namespace interflect
