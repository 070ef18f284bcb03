#include <cstdlib>
#include <stdexcept>
#include <string>

#include "interflect/ranks.h"

namespace interflect {

std::shared_ptr<Ranks> join_ranks() {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* count = std::getenv(name); count && std::string(count) != "1")
            throw std::runtime_error("this Interflect was built without MPI, so " + std::string(count) +
                                     " processes would all do the same: build it with -DINTERFLECT_MPI=ON, or start it "
                                     "without mpirun");
    return nullptr;
}

}  // namespace interflect
