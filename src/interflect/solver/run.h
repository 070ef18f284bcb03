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

/// The data of a Solver.
struct Run {
    /// @param caster  Ray caster of this scene. @throws InputError as Solver does.
    Run(std::shared_ptr<const Scene> s, std::shared_ptr<const RayCaster> caster, const SolveOptions& options);

    const std::shared_ptr<const Scene> undimmed_scene;
    std::shared_ptr<const Scene> scene = undimmed_scene;  // scene with the current exitances
    const std::shared_ptr<const RayCaster> ray_caster;
    SolverState state;
    const std::unique_ptr<IterationMethod> method;
    bool is_prepared = false, is_finished = false;
    double error = std::numeric_limits<double>::infinity();  // estimated error for the current views
    int iteration = 0;
    std::vector<float> known_dimming;  // dimming factors of the stored light, which dark groups keep

    std::mutex finishing;  // guards `finished`
    std::shared_ptr<const Solution> finished;

    void dim(std::size_t group, float factor);
    /// Returns the current solution, with a copy of the forest.
    Solution snapshot();
    /// @throws std::runtime_error if the data are inconsistent.
    void archive(StateArchive& archive);

  private:
    void dim_sources();
};

/// Runs iterations until a limit of the call or of the run is reached. @throws Interrupted
void iterate_until(Run& run, const Limits& call_limits);

}  // namespace interflect::detail
