#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {
class StateArchive;
}  // namespace interflect::inline detail

namespace interflect {

/// Where a run stands.
struct AdvanceReport {
    double error = std::numeric_limits<double>::infinity();  ///< Estimated; infinite as long as it is not known.
    std::int64_t rays = 0;                                   ///< Since the run began.
    double seconds = 0;                                      ///< Spent in advance(), likewise.
    bool is_finished = false;                                ///< There is nothing left to do within SolveOptions.
    bool is_stopped = false;                                 ///< Monitor::stop ended it.
};

/// Solves Eq. 1 of Prikryl et al. 2000 step by step: each iteration shoots N rays, chosen by power (Eq. 3) or by power
/// and importance (Eq. 9-11), refines the mesh where its method says so (Eq. 14, 15), and is merged with the running
/// mean (Eq. 6).
///
/// SolveOptions are the plan of the whole run: they alone decide how its iterations are sized, and where it ends. The
/// Limits of advance() only decide when it returns; the work that is then under way goes on with the next call. So many
/// small calls, or saving and opening in between, give the same bits as one call, on any number of threads. Only
/// Limits::time of the plan makes iterations depend on how fast they are.
class Solver {
  public:
    /// @throws InputError listing every option out of range and every fault of the scene; for a view that defines no
    /// picture. A scene without light is legal.
    Solver(Scene scene, const SolveOptions& options);
    Solver(const std::shared_ptr<const Scene>& scene, const SolveOptions& options);
    /// @param ray_caster  Of the same scene, otherwise InputError.
    Solver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> ray_caster,
           const SolveOptions& options);
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    /// Goes on until a limit is reached, the plan is fulfilled, or Monitor::stop is set, which another thread or a
    /// signal handler may do. Rays that are asked for beyond a plan that is fulfilled are added to it.
    /// @param limits  Rays and time count from now on. The last iteration is whole: `rays` may be exceeded. No step of
    ///                rays begins after `time`, but one is always traced.
    AdvanceReport advance(const Limits& limits, const Monitor& monitor = {});

    /// Goes on with other views: what is known of the light is kept, importance is found anew.
    /// @throws InputError as the constructor does; then the views are as before.
    void set_views(std::vector<WeightedView> views);
    /// Scales the sources of a light group of the scene: 1 is what the scene says they emit. The light of the group is
    /// scaled with them at once.
    /// @throws InputError for a group that there is not, for a factor that is negative or not finite, and unless the
    /// method averages iterations (Method::follows_dimming).
    void set_exitance(const std::string& group, float factor);
    /// Replaces SolveOptions::limits, which count from the beginning of the run.
    /// @throws InputError for one out of range.
    void set_plan(const Limits& limits);

    /// The light as far as it is known. Made when it is first asked for, in O(elements); the reference holds until the
    /// solver changes, a copy for ever.
    const Solution& solution() const;
    /// The same without a copy; the solver is of no use any more.
    Solution take_solution() &&;
    /// With its sources as set_exitance() has scaled them.
    const Scene& scene() const { return *shared_scene(); }
    const RayCaster& ray_caster() const { return *shared_ray_caster(); }
    std::shared_ptr<const Scene> shared_scene() const;
    std::shared_ptr<const RayCaster> shared_ray_caster() const;
    const SolveOptions& options() const;

    /// Writes all that is needed to go on to a solution file (docs/solution-file.md), by way of a temporary file.
    /// @throws std::runtime_error where it cannot be written.
    void save(const std::filesystem::path& path);
    /// What save() wrote. @throws InputError for a file that is missing, damaged, without the state of a run, or of
    /// another version of Interflect.
    static Solver open(const std::filesystem::path& path);

  private:
    struct Run;
    void archive(StateArchive& archive);
    std::shared_ptr<const Scene> undimmed_scene() const;
    const std::vector<float>& dimming() const;

    std::unique_ptr<Run> run_;
};

}  // namespace interflect
