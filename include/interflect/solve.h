#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "interflect/colour.h"
#include "interflect/point_set.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {
class ElementForest;
class IterationMethod;
struct SolverState;
}  // namespace interflect::inline detail

namespace interflect {

/// A view and how much it counts beside others.
struct WeightedView {
    View view = {};
    double weight = 1;         ///< > 0; what counts is its share of the sum of all.
    float aspect = 16.0f / 9;  ///< Width over height of the picture.
    int pixel_rows = 720;      ///< Of the picture, > 0: elements need be no smaller than what a pixel shows.
};

/// What importance steers.
enum class ImportanceUse {
    off,     ///< Nothing: every leaf shoots by its power (Eq. 3).
    direct,  ///< What the view shows, V alone: what 'prioritise the view' often means.
    full,    ///< What the view shows and what lights that: V and all its bounces (Eq. 7).
};

/// What decides where the mesh is refined. See refine_by_variance() and Oracle.
enum class RefinementCriterion {
    variance,  ///< Elements are split where their children are expected to differ by more than their noise.
    power,     ///< Pairs of elements are split by the power that passes between them (Eq. 14, 15), as in the paper.
};

/// Makes what does a method's iterations. The state must outlive it.
using MakeIterationMethod = std::unique_ptr<IterationMethod>(SolverState& state);

/// A method is data: what does its iterations, what steers them, and what others need to know of it. They are listed in
/// methods/table.cpp.
struct Method {
    const char* name;
    const char* source;             ///< Author and year.
    MakeIterationMethod* make;      ///< Null only of automatic_method.
    bool refines = false;           ///< Hierarchical: makes elements below the patches.
    bool follows_variance = false;  ///< Can refine by RefinementCriterion::variance; others do by power.
    ImportanceUse importance = ImportanceUse::off;  ///< Taken as `off` where there is no view.
    const char* no_importance = nullptr;            ///< Why importance cannot steer it; null: it can.
    bool is_stochastic = true;                      ///< Its noise is measured, and falls with the rays.
    bool takes_luminaires = true;                   ///< Light sources that are no surfaces shine.
    bool separates_groups = false;                  ///< Keeps what each light group brings apart.
    bool follows_dimming = false;  ///< Can go on with groups that shine otherwise, see Solver::set_exitance().
};

/// All there are.
extern const std::span<const Method> methods;

/// The method of that name. @throws InputError that lists the methods there are.
const Method& find_method(const std::string& name);

/// What SolveOptions begin with: Solver takes default_method().
inline constexpr Method automatic_method{.name = "automatic", .source = "", .make = nullptr};
/// ihsrr where there are views, else hsrr.
const Method& default_method(bool has_views);

/// Beyond that the fixed-point sums of transport would round what single rays carry.
inline constexpr std::int64_t most_rays_per_iteration = 100'000'000'000;
inline constexpr int most_camera_rays = 1 << 22;

/// Where to stop: at the first limit that is reached. Each is unlimited unless it is given.
struct Limits {
    std::int64_t rays = std::numeric_limits<std::int64_t>::max();  ///< To trace in all; > 0.
    double time = std::numeric_limits<double>::infinity();         ///< Spent on solving [s]; > 0.
    double until = 0;  ///< Estimated relative error (IterationReport::error_estimate), in [0, 1); 0: none.
};

/// Where and how far the mesh is refined, by methods that do (Method::refines).
struct RefinementOptions {
    /// Of methods that can (Method::follows_variance), unless ExperimentalOptions::one_bounce; all others refine by
    /// power.
    RefinementCriterion criterion = RefinementCriterion::variance;
    /// No element smaller than this [m^2]; >= 0. 0: with a view, the area that a pixel shows of the element; of
    /// elements that no view shows, and without a view, (5 mm)^2 or less, by the scene's size.
    double min_area = 0;
    std::size_t max_elements = std::size_t{1} << 26;  ///< Refinement ends there; at least the number of patches.
};

/// How the views steer the work. Whether they do is Method::importance.
struct ImportanceOptions {
    int camera_rays = 1 << 16;  ///< Rays that find V at first, per view; 1 to most_camera_rays. More follow later.
    /// How much of its parent's importance drives an element's rays and refinement, and to which power importance
    /// drives rays; in [0, 1]. 0 and 1: as in the paper.
    double smoothing = 0.9, exponent = 0.75;
};

/// What the paper varies, and what is measured against it. The defaults are good ones; names, meanings and defaults may
/// change with any version.
struct ExperimentalOptions {
    PointSet points = PointSet::sobol;

    /// False: each iteration is a pass of its own, which follows light from the emitters bounce by bounce until little
    /// is left; passes are independent, and their mean is kept. True: the paper's, from darkness through warm_up
    /// iterations, each of which is one bounce of the running mean; methods that keep every ray do not begin with a
    /// pass.
    bool one_bounce = false;
    int warm_up = 0;     ///< Iterations with tau = 1 before averaging begins; >= 0.
    int iterations = 0;  ///< Averaged iterations; 0: as many as the limits allow. >= 0.
    /// Rays of each iteration; 0: begins small and grows with the rays already averaged. At most
    /// most_rays_per_iteration.
    std::int64_t rays_per_iteration = 0;

    /// With RefinementCriterion::variance, differences that are mostly noise are reduced (docs/method.md).
    bool shrinkage = true;
    /// Threshold of Eq. 14 and 15 once 20 million rays are averaged, relative to the power that is seen
    /// (without a view: emitted); > 0. Method hr takes it as it is.
    double epsilon = 4e-8;
    /// After N rays the threshold is in proportion to N^-decay, so that the mesh gets finer as the noise falls; in [0,
    /// 1]. At 0 it is the same for all iterations, as in the paper.
    double epsilon_decay = 0.75;
    /// How much what a new element inherits counts for it in later iterations, since it is too smooth; in [0, 1].
    /// At 1 all elements are averaged alike, as in the paper.
    double inherited_weight = 0.1;
    bool defer_refinement = false;  ///< No refinement before averaging begins ('dr').

    bool separate_iterations = false;    ///< Importance and power in steps of their own ('si'), else combined ('ci').
    bool importance_at_patches = false;  ///< Importance is kept by patches, else by leaves ('hi').
    bool total_importance = false;       ///< Eq. 9 in place of Eq. 10.
    double alpha = 0.1;                  ///< Share of the rays for importance, Eq. 11; in [0, 1].
    double beta = 0.1;  ///< Share of the power rays that follow power alone, so that nothing is missed; in [0, 1].
};

/// What to compute and when to stop. A setting has one name in the library, on the command line and in files:
/// docs/design.md lists them.
struct SolveOptions {
    Method method = automatic_method;
    std::vector<WeightedView> views = {};  ///< What is looked at; empty: there is no importance.
    /// Of the whole run. An iteration that Limits::time cuts short is lost; bits then depend on speed.
    Limits limits{.rays = 20'000'000};
    std::uint64_t seed = 1;
    RefinementOptions refinement = {};
    ImportanceOptions importance = {};
    ExperimentalOptions experimental = {};
};

/// Where a run stands after an iteration; counts since its start.
struct IterationReport {
    int iteration = 0;  ///< 0 is the incremental start, where there is one.
    double seconds = 0;
    std::int64_t rays = 0;             ///< Of these:
    std::int64_t power_rays = 0;       ///< in proportion to what is asked of power, and
    std::int64_t importance_rays = 0;  ///< of importance; in a combined iteration every ray carries both.
    std::int64_t escaped_rays = 0;
    std::uint32_t elements = 0, leaves = 0;
    RgbD total_power{0, 0, 0};    ///< Sum of P [lm or W].
    RgbD escaped_power{0, 0, 0};  ///< Lost through the openings of the scene, averaged as irradiance is [lm or W].
    /// Estimated relative error of the solution, element by element. With a view: of the luminance of the reflected
    /// light that it shows, root of the mean square over the picture, over the mean; emission enters neither. Without:
    /// of the irradiance, likewise over the area. The root of the sum of squares of the two below; infinite as long as
    /// nothing is known, and where a view shows nothing that reflects light.
    double error_estimate = std::numeric_limits<double>::infinity();
    double noise_estimate = std::numeric_limits<double>::infinity();           ///< Standard error.
    double discretisation_estimate = std::numeric_limits<double>::infinity();  ///< What the mesh smooths away.
    /// Power that a ray carries, over the mean of all: the largest, and that which 0.1% of the rays exceed.
    double largest_quantum = 1, high_quantum = 1;
};

/// The light on the surfaces, and how it was found. Every vector has an entry for every element of the forest; inner
/// elements have the mean of their children.
struct Solution {
    std::shared_ptr<const ElementForest> forest;
    std::vector<Rgb> irradiance;  ///< H [lm/m^2 or W/m^2].
    /// Of H what each light group brings, [group][element]: they sum to H. Empty unless the scene has light groups.
    std::vector<std::vector<Rgb>> groups;
    std::vector<std::string> group_names;  ///< As in source_groups(scene).
    /// Of each group: what the sources of the scene are still to be scaled by. 1 but in the files that Solver::save()
    /// writes, whose scene has its sources as they were.
    std::vector<float> dimming;
    std::vector<float> view_importance;       ///< v; empty where there is no view.
    std::vector<float> indirect_importance;   ///< psi - v; likewise.
    std::vector<float> standard_error;        ///< Estimated, of the luminance of H [as H].
    std::vector<float> discretisation_error;  ///< Estimated: how far H within the element is from its mean [as H].
    std::vector<float> rays;                  ///< How many started on it.
    SolveOptions options;
    std::vector<IterationReport> iterations;
    RgbD emitted_power{0, 0, 0};  ///< Sum of W [lm or W].
    std::int64_t non_finite = 0;  ///< Non-finite radiosities met (and not shot); 0 unless something is wrong.
    bool interrupted = false;     ///< Stopped by the caller before any limit was reached.
};

/// How a caller follows a run, and ends it early.
struct Monitor {
    std::function<void(const IterationReport&)> report;  ///< After each iteration, on the calling thread; may be empty.
    const std::atomic<bool>* stop = nullptr;             ///< Once true, the run ends; the iteration under way is lost.
};

/// Solves Eq. 1 of Prikryl et al. 2000 for the irradiance of every element: each iteration shoots N rays, chosen by
/// power (Eq. 3) or by power and importance (Eq. 9-11), refines the mesh where its method says so (Eq. 14, 15), and is
/// merged with the running mean (Eq. 6).
/// @param ray_caster  Of the same scene.
/// @throws InputError listing every option out of range and every fault of the scene; for a ray caster of another scene
///         and for a view that defines no picture. A scene without light is legal.
Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
               const Monitor& monitor = {});

}  // namespace interflect
