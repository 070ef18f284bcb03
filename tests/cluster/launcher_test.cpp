// Processes that a launcher started together must notice it; otherwise each would write the same files.

#include "interflect/cluster/launcher.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <utility>

#include "interflect/ranks.h"

namespace interflect::detail {
namespace {

using Variable = std::pair<const char*, const char*>;

/// Sets the variables of a launcher and no others.
class Environment {
  public:
    explicit Environment(std::initializer_list<Variable> variables) {
        for (const char* name : all) ::unsetenv(name);
        for (const auto& [name, value] : variables) ::setenv(name, value, 1);
    }
    ~Environment() {
        for (const char* name : all) ::unsetenv(name);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    static constexpr std::initializer_list<const char*> all = {
        "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE",    "PMI_RANK", "PMIX_RANK",
        "SLURM_STEP_NUM_TASKS", "SLURM_PROCID",         "SLURM_NTASKS"};
};

TEST(Launcher, IsAbsentInAPlainShell) {
    const Environment environment({});
    EXPECT_EQ(launched_processes(), std::nullopt);
    EXPECT_EQ(launched_rank(), std::nullopt);
}

/// Slurm runs the script itself once, whatever the number of tasks of the job.
TEST(Launcher, IsAbsentInABatchScriptOfSlurm) {
    const Environment environment({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "4"}});
    EXPECT_EQ(launched_processes(), std::nullopt);
}

TEST(Launcher, IsMpirun) {
    const Environment environment({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_RANK", "3"}, {"PMIX_RANK", "3"}});
    EXPECT_EQ(launched_processes(), 4);
    EXPECT_EQ(launched_rank(), 3);
}

TEST(Launcher, IsSrunWithPmix) {
    const Environment environment({{"SLURM_STEP_NUM_TASKS", "4"}, {"SLURM_PROCID", "2"}, {"PMIX_RANK", "2"}});
    EXPECT_EQ(launched_processes(), 4);
    EXPECT_EQ(launched_rank(), 2);
}

TEST(Launcher, IsSrunWithoutMpi) {
    const Environment environment({{"SLURM_STEP_NUM_TASKS", "4"}, {"SLURM_PROCID", "2"}});
    EXPECT_EQ(launched_processes(), 4);
}

TEST(Launcher, IsMpiexecOfMpich) {
    const Environment environment({{"PMI_SIZE", "2"}, {"PMI_RANK", "1"}});
    EXPECT_EQ(launched_processes(), 2);
    EXPECT_EQ(launched_rank(), 1);
}

TEST(Launcher, MayHideTheNumberOfProcesses) {
    const Environment environment({{"PMIX_RANK", "0"}});
    EXPECT_EQ(launched_processes(), 0);
}

}  // namespace
}  // namespace interflect::detail
