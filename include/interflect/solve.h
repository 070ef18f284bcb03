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

/// A view with a relative weight.
struct WeightedView {
    View view = {};
    double weight = 1;         ///< > 0; normalised by the sum of all weights.
    float aspect = 16.0f / 9;  ///< Width over height of the picture.
    int pixel_rows = 720;      ///< Rows of the picture, > 0. Limits the element size: see RefinementOptions::min_area.
};

/// Part of the importance that controls sampling and refinement.
enum class ImportanceUse {
    off,     ///< No importance: leaves shoot rays by power (Eq. 3).
    direct,  ///< View importance V: directly visible surfaces only.
    full,    ///< V and all its bounces (Eq. 7): visible surfaces and their illumination.
};

/// Refinement criterion of the mesh. See refine_by_variance() and Oracle.
enum class RefinementCriterion {
    variance,  ///< Splits elements whose children are expected to differ by more than their noise.
    power,     ///< Splits pairs of elements by the power exchanged between them (Eq. 14, 15), as in the paper.
};

/// The state must outlive the result.
using MakeIterationMethod = std::unique_ptr<IterationMethod>(SolverState& state);

/// A solution method. All are listed in solver/methods/table.cpp.
struct Method {
    const char* name;
    const char* source;                             ///< Author and year.
    MakeIterationMethod* make;                      ///< Null only for automatic_method.
    bool refines = false;                           ///< Hierarchical: creates elements below the patches.
    bool follows_variance = false;                  ///< Supports RefinementCriterion::variance; others refine by power.
    ImportanceUse importance = ImportanceUse::off;  ///< Treated as `off` without views.
    const char* no_importance = nullptr;            ///< Reason why importance is not supported; null if it is.
    bool is_stochastic = true;                      ///< Its noise is measured and decreases with the rays.
    bool takes_luminaires = true;                   ///< Supports light sources that are not surfaces.
    bool separates_groups = false;                  ///< Keeps the light of each light group separate.
    bool follows_dimming = false;                   ///< Can continue with dimmed groups, see Solver::set_exitance().
};

/// All methods.
extern const std::span<const Method> methods;

/// The method of that name. @throws InputError that lists the methods.
const Method& find_method(const std::string& name);

/// Default of SolveOptions, replaced by default_method().
inline constexpr Method automatic_method{.name = "automatic", .source = "", .make = nullptr};
/// ihsrr with views, else hsrr.
const Method& default_method(bool has_views);

/// Above this, the fixed-point sums of transport would round the payload of single rays.
inline constexpr std::int64_t most_rays_per_iteration = 100'000'000'000;
inline constexpr int most_camera_rays = 1 << 22;

/// Limits of a run, which stops at the first one reached.
struct Limits {
    std::int64_t rays = std::numeric_limits<std::int64_t>::max();  ///< Total number of rays; > 0.
    double time = std::numeric_limits<double>::infinity();         ///< Time spent on solving [s]; > 0.
    double until = 0;  ///< Target of IterationReport::error_estimate, in [0, 1); 0: no target.
};

/// Mesh refinement (Method::refines).
struct RefinementOptions {
    /// For methods with Method::follows_variance, unless ExperimentalOptions::one_bounce; others refine by power.
    RefinementCriterion criterion = RefinementCriterion::variance;
    /// Smallest element area [m^2]; >= 0. If 0: the area covered by a pixel, for visible elements; for others at most
    /// (5 mm)^2, depending on the scene's size.
    double min_area = 0;
    std::size_t max_elements = std::size_t{1} << 26;  ///< Refinement stops there; at least the number of patches.
};

/// Use of the views (Method::importance).
struct ImportanceOptions {
    int camera_rays = 1 << 16;  ///< Rays per view of the first estimate of V, 1 to most_camera_rays; more follow later.
    /// Fraction of the parent's importance in the importance that controls an element's rays and refinement; exponent
    /// of importance in the sampling probability. In [0, 1]; 0 and 1, respectively, as in the paper.
    double smoothing = 0.9, exponent = 0.75;
};

/// Variants of the paper. Names, meanings and defaults may change with any version.
struct ExperimentalOptions {
    PointSet points = PointSet::sobol;

    /// False: each iteration is an independent pass, which follows light from the emitters until little is left; passes
    /// are averaged. True: as in the paper, each iteration is one bounce of the running mean, from darkness through
    /// warm_up iterations; methods that keep every ray then skip the initial pass.
    bool one_bounce = false;
    int warm_up = 0;     ///< Iterations with tau = 1 before averaging begins; >= 0.
    int iterations = 0;  ///< Number of averaged iterations, >= 0; 0: until a limit is reached.
    /// Rays per iteration, at most most_rays_per_iteration; 0: grows with the number of rays averaged.
    std::int64_t rays_per_iteration = 0;

    /// With RefinementCriterion::variance: reduces differences that are mostly noise (docs/method.md).
    bool shrinkage = true;
    /// Threshold of Eq. 14 and 15 at 20 million averaged rays, relative to visible power (without a view: emitted
    /// power); > 0. Method hr uses it unchanged.
    double epsilon = 4e-8;
    /// The threshold is proportional to N^-decay after N rays, so the mesh gets finer as noise decreases; in [0, 1]. 0:
    /// constant, as in the paper.
    double epsilon_decay = 0.75;
    /// Weight of a new element's inherited value in later averages, since that value is too smooth; in [0, 1]. 1: as in
    /// the paper.
    double inherited_weight = 0.1;
    bool defer_refinement = false;  ///< No refinement before averaging begins ('dr').

    bool separate_iterations = false;    ///< Separate steps for importance and power ('si'), else combined ('ci').
    bool importance_at_patches = false;  ///< Importance per patch, else per leaf ('hi').
    bool total_importance = false;       ///< Eq. 9 instead of Eq. 10.
    double alpha = 0.1;                  ///< Fraction of rays for importance, Eq. 11; in [0, 1].
    double beta = 0.1;  ///< Fraction of power rays that ignore importance, so all light is sampled; in [0, 1].
};

/// Plan of a run. Settings have the same names in the library, on the command line and in files; see docs/design.md.
struct SolveOptions {
    Method method = automatic_method;
    std::vector<WeightedView> views = {};  ///< Views that define importance; without views importance is off.
    /// Limits of the whole run. An iteration cut short by Limits::time is discarded; results then depend on speed.
    Limits limits{.rays = 20'000'000};
    std::uint64_t seed = 1;
    RefinementOptions refinement = {};
    ImportanceOptions importance = {};
    ExperimentalOptions experimental = {};
};

/// Changes the settings to the algorithm as published in Prikryl et al. 2000: iterations of one bounce from darkness,
/// of which 10 warm up and 100 of equal size are averaged; refinement by Eq. 14 and 15 with one threshold; importance
/// without smoothing; no shrinkage. Iterations have 1/110 of Limits::rays, or grow if those are unlimited. This is the
/// variant ci+hi; ExperimentalOptions has the others.
void use_published_algorithm(SolveOptions& options);

/// State of a run after an iteration. Counts since the start.
struct IterationReport {
    int iteration = 0;  ///< 0 is the incremental start, if any.
    double seconds = 0;
    std::int64_t rays = 0;             ///< Sum of the two below; in a combined iteration every ray carries both.
    std::int64_t power_rays = 0;       ///< For power, by the sampling distribution.
    std::int64_t importance_rays = 0;  ///< For importance; combined iterations split their rays in proportion.
    std::int64_t escaped_rays = 0;
    std::uint32_t elements = 0, leaves = 0;
    RgbD total_power{0, 0, 0};    ///< Sum of P [lm or W].
    RgbD escaped_power{0, 0, 0};  ///< Power lost through openings, averaged as irradiance is [lm or W].
    /// Estimated relative error: root of the sum of squares of the two estimates below. With a view: root mean square
    /// over the picture, relative to the mean, for visible reflected luminance without emission. Without: the same for
    /// irradiance, over the area. Infinite before an estimate exists, and if a view shows no reflected light.
    double error_estimate = std::numeric_limits<double>::infinity();
    double noise_estimate = std::numeric_limits<double>::infinity();           ///< Standard error.
    double discretisation_estimate = std::numeric_limits<double>::infinity();  ///< Mean deviation within elements.
    /// Payload of a ray relative to the mean of all rays: maximum, and value exceeded by 0.1% of the rays.
    double largest_quantum = 1, high_quantum = 1;
};

/// Solution and history of a run. Vectors have one entry per element of the forest; inner elements hold the mean of
/// their children.
struct Solution {
    std::shared_ptr<const ElementForest> forest;
    std::vector<Rgb> irradiance;  ///< H [lm/m^2 or W/m^2].
    /// Parts of H by light group, [group][element]; they sum to H. Empty without light groups.
    std::vector<std::vector<Rgb>> groups;
    std::vector<std::string> group_names;  ///< As in source_groups(scene).
    /// Remaining scale factor of each group's sources: 1, except in files of Solver::save(), whose scene is not dimmed.
    std::vector<float> dimming;
    /// Largest channel of M + H of each patch before dim() [as H]; empty if not dimmed. Exports choose the faces that
    /// they show from it, so that all dimmed states have the same faces.
    std::vector<float> undimmed_light;
    std::vector<float> view_importance;       ///< v; empty without a view.
    std::vector<float> indirect_importance;   ///< psi - v; empty without a view.
    std::vector<float> standard_error;        ///< Estimate for the luminance of H [as H].
    std::vector<float> discretisation_error;  ///< Estimated deviation of H within the element from its mean [as H].
    std::vector<float> rays;                  ///< Number of rays started on the element.
    SolveOptions options;
    std::vector<IterationReport> iterations;
    RgbD emitted_power{0, 0, 0};  ///< Sum of W [lm or W].
    std::int64_t non_finite = 0;  ///< Non-finite radiosities, which are not shot; 0 in a correct run.
    bool interrupted = false;     ///< Stopped by the caller before a limit was reached.
};

/// Progress reports and early termination of a run.
struct Monitor {
    std::function<void(const IterationReport&)> report;  ///< After each iteration, on the calling thread; may be empty.
    const std::atomic<bool>* stop = nullptr;  ///< Ends the run once true; the current iteration is discarded.
};

/// Solves Eq. 1 of Prikryl et al. 2000 for the irradiance of every element. Each iteration shoots N rays, sampled by
/// power (Eq. 3) or by power and importance (Eq. 9-11), refines the mesh if the method supports it (Eq. 14, 15), and is
/// merged with the running mean (Eq. 6).
/// @param ray_caster  Of the same scene.
/// @throws InputError listing every option out of range and every fault of the scene; also for a ray caster of another
///         scene and for a view that defines no picture. A scene without light is valid.
Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
               const Monitor& monitor = {});

}  // namespace interflect
