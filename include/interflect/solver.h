/// @file
/// A run of the solver that can be continued, changed and saved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"
#include "interflect/solve_options.h"

namespace interflect {

namespace detail {
struct Run;
struct SavedRun;
}  // namespace detail

/// State of a run when Solver::advance() returns.
struct AdvanceReport {
    double error = std::numeric_limits<double>::infinity();  ///< Estimated error; infinite before an estimate exists.
    std::int64_t rays = 0;                                   ///< Number of rays since the run began.
    double seconds = 0;                                      ///< Time in Solver::advance() since the run began [s].
    bool is_finished = false;                                ///< Whether the run has reached a limit of its plan.
    bool is_stopped = false;                                 ///< Whether Monitor::stop ended it.
};

/// Solves Eq. 1 of Prikryl et al. 2000 step by step; see solve().
///
/// The settings are the plan of the whole run: they determine the size of its iterations and its end. The limits of
/// advance() only determine when it returns. Iterations are atomic: a stopped iteration is discarded, and the next
/// call repeats it. Many small calls, also with save() and open() in between, therefore give the same bits as
/// one call, on any number of threads. The exception is a limit of time in the plan, which makes iterations depend on
/// speed.
/// @note Const functions may be called from several threads at a time.
class Solver {
  public:
    /// @throws InputError listing every option out of range and every fault of the scene; also for a view that defines
    ///         no picture. A scene without light is valid.
    Solver(Scene scene, const SolveOptions& options);
    /// Makes a solver without a copy of the scene.
    /// @param ray_caster  Of this scene, otherwise InputError; null: made here.
    Solver(std::shared_ptr<const Scene> scene, const SolveOptions& options,
           std::shared_ptr<const RayCaster> ray_caster = nullptr);
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    /// Continues until a limit is reached, the plan is complete or the run is stopped. Rays requested beyond a complete
    /// plan extend it. Rays and time count from this call. The last iteration is completed, so the rays may be
    /// exceeded. No iteration begins after the time limit, but at least one is completed, in a second or two.
    /// @param monitor  Its `stop` may be set by another thread or a signal handler.
    AdvanceReport advance(const Limits& limits, const Monitor& monitor = {});

    /// Continues with other views. Keeps the light; recomputes importance.
    /// @throws InputError as the constructor does; the views are then unchanged.
    void set_views(std::vector<WeightedView> views);
    /// Scales the sources of a light group and their light, relative to the original scene.
    /// @throws InputError for an unknown group, for a factor that is negative or not finite, and for methods that do
    ///         not average iterations (Method::follows_dimming).
    void set_dimming(const std::string& group, float factor);
    /// Replaces the limits of the plan, which count from the beginning of the run.
    /// @throws InputError for a limit out of range.
    void set_plan(const Limits& limits);

    /// Returns the current solution, which is computed on first request in O(elements).
    /// @note The reference is valid until the solver changes.
    const Solution& solution() const;
    /// Returns the current solution without a copy. It remains valid when the solver changes or is destroyed.
    std::shared_ptr<const Solution> shared_solution() const;
    /// Returns the current solution without a copy. The solver must not be used afterwards.
    Solution take_solution() &&;
    /// Returns the scene, with its sources scaled by set_dimming().
    const Scene& scene() const { return *shared_scene(); }
    const RayCaster& ray_caster() const { return *shared_ray_caster(); }
    std::shared_ptr<const Scene> shared_scene() const;
    std::shared_ptr<const RayCaster> shared_ray_caster() const;
    const SolveOptions& options() const;

    /// Writes the complete state to a solution file (docs/files/solution-file.md), through a temporary file.
    /// @throws std::runtime_error if it cannot be written.
    void save(const std::filesystem::path& path) const;
    /// Returns the bytes of a file of save() without checksums, for another process of the same program.
    std::string image() const;
    /// Reads a file of save(). @throws InputError for a file that is missing, damaged, without the state of a run, or
    /// of another version of Interflect.
    static Solver open(const std::filesystem::path& path);
    /// Reads the bytes of image(). @throws std::runtime_error if they are damaged.
    static Solver open_image(std::span<const char> image);

  private:
    static Solver restored(detail::SavedRun&& saved);

    std::unique_ptr<detail::Run> run_;
};

}  // namespace interflect
