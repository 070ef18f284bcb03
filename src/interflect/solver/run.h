#pragma once

#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

struct Run {
    /// @param caster  Of this scene. @throws InputError as Solver does.
    Run(std::shared_ptr<const Scene> s, std::shared_ptr<const RayCaster> caster, const SolveOptions& options);

    const std::shared_ptr<const Scene> undimmed_scene;
    std::shared_ptr<const Scene> scene = undimmed_scene;  // with current exitances
    const std::shared_ptr<const RayCaster> ray_caster;
    SolverState state;
    const std::unique_ptr<IterationMethod> method;
    bool is_prepared = false, is_finished = false;
    double error = std::numeric_limits<double>::infinity();  // for the current views
    int iteration = 0;
    std::vector<float> known_dimming;  // factors of the stored light

    std::mutex finishing;  // guards `finished`
    std::shared_ptr<const Solution> finished;

    void dim(std::size_t group, float factor);
    /// Copies the forest.
    Solution snapshot();
    /// @throws std::runtime_error if the data are inconsistent.
    void archive(StateArchive& archive);

  private:
    void dim_sources();
};

/// Main loop, until a limit of the call or the run. @throws Interrupted
void iterate_until(Run& run, const Limits& call_limits);

}  // namespace interflect::detail
