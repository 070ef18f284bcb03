/// @file
/// Settings of the solver: methods, views, limits, refinement, importance.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/scene.h"

namespace interflect {

/// A view with a relative weight.
struct WeightedView {
    View view = {};
    double weight = 1;         ///< > 0; normalised by the sum of all weights.
    float aspect = 16.0f / 9;  ///< Width over height of the picture.
    int pixel_rows = 720;      ///< Rows of the picture, > 0. Limits the element size (RefinementOptions::min_area).
};

/// Part of the importance that controls sampling and refinement.
enum class ImportanceUse {
    off,     ///< No importance: leaves shoot rays by power (Eq. 3).
    direct,  ///< View importance V: directly visible surfaces only.
    full,    ///< V and all its bounces (Eq. 7): visible surfaces and their illumination.
};

/// Refinement criterion of the mesh (docs/method/method.md, A run).
enum class RefinementCriterion {
    variance,  ///< Splits elements whose children are expected to differ by more than their noise.
    /// Splits elements whose children are expected to differ visibly, and by more than their noise. Needs views and
    /// full importance.
    perceptual,
    power,  ///< Splits pairs of elements by the power exchanged between them (Eq. 14, 15), as in the paper.
};

/// Properties of a solution method, for choosing one from `methods`.
struct Method {
    const char* name = "";
    const char* source = "";                        ///< Author and year.
    bool refines = false;                           ///< Hierarchical: creates elements below the patches.
    bool follows_variance = false;                  ///< Supports RefinementCriterion::variance and perceptual.
    ImportanceUse importance = ImportanceUse::off;  ///< Treated as `off` without views.
    const char* no_importance = nullptr;            ///< Reason why importance is not supported; null if it is.
    bool is_stochastic = true;                      ///< Its noise is measured and decreases with the rays.
    bool takes_luminaires = true;                   ///< Supports light sources that are not surfaces.
    std::size_t bytes_per_ray = 0;                  ///< Peak memory per ray of methods that keep all rays; others 0.
    bool separates_groups = false;                  ///< Keeps the light of each light group separate.
    bool separates_direct = false;                  ///< Supports SolveOptions::keep_direct.
    bool shares_rays = false;                       ///< Divides its rays among Monitor::ranks; others repeat all work.
    bool follows_dimming = false;                   ///< Can continue with dimmed groups, see Solver::set_dimming().
};

/// All methods.
extern const std::span<const Method> methods;

/// Returns the method of that name. @throws InputError that lists the methods.
const Method& find_method(const std::string& name);

/// Default of SolveOptions, which default_method() replaces.
inline constexpr Method automatic_method{.name = "automatic"};
/// Returns the method ihsrr if there are views, else hsrr.
const Method& default_method(bool has_views);

/// With more rays, the fixed-point sums of transport would round the payload of single rays.
inline constexpr std::int64_t max_rays_per_iteration = 100'000'000'000;
inline constexpr int max_camera_rays = 1 << 22;

/// Limits of a run, which stops at the first one reached.
struct Limits {
    std::int64_t rays = std::numeric_limits<std::int64_t>::max();  ///< Total number of rays; > 0.
    double time = std::numeric_limits<double>::infinity();         ///< Time spent on solving [s]; > 0.
    double until = 0;  ///< Target of IterationReport::error_estimate, in [0, 1); 0: no target.
};

/// Mesh refinement (Method::refines).
struct RefinementOptions {
    /// For methods with Method::follows_variance, unless ExperimentalOptions::one_bounce; others refine by power.
    /// Without a visible surface, `perceptual` is the same as `variance`.
    RefinementCriterion criterion = RefinementCriterion::variance;
    /// Smallest element area [m^2]; >= 0. If 0: the area covered by a pixel, for visible elements; for others at most
    /// (5 mm)^2, depending on the scene's size.
    double min_area = 0;
    std::size_t max_elements = std::size_t{1} << 26;  ///< Refinement stops there; at least the number of patches.
};

/// Use of the views (Method::importance).
struct ImportanceOptions {
    int camera_rays = 1 << 16;  ///< Rays per view of the first estimate of V, 1 to max_camera_rays; more follow later.
    /// Fraction of the parent's importance in the importance that controls an element's rays and refinement, in [0, 1];
    /// 0: as in the paper.
    double smoothing = 0.9;
    double exponent = 0.75;  ///< Exponent of importance in the sampling probability, in [0, 1]; 1: as in the paper.
};

/// Variants of the paper. Names, meanings and defaults may change with any version.
struct ExperimentalOptions {
    PointSet points = PointSet::sobol;

    /// If false, each iteration is an independent pass, which follows light from the emitters until little is left;
    /// passes are averaged. If true, each iteration is one bounce of the running mean, as in the paper, from darkness
    /// through warm_up iterations; methods that keep every ray then skip the initial pass.
    bool one_bounce = false;
    int warm_up = 0;     ///< Iterations before averaging begins, >= 0; each replaces the mean (tau = 1 in Eq. 6).
    int iterations = 0;  ///< Number of averaged iterations, >= 0; 0: until a limit is reached.
    /// Rays per iteration, at most max_rays_per_iteration; 0: grows with the number of rays averaged.
    std::int64_t rays_per_iteration = 0;

    /// With RefinementCriterion::variance: whether differences that are mostly noise are reduced
    /// (docs/method/method.md).
    bool shrinkage = true;
    /// Whether shrinkage also reduces differences between neighbouring patches with similar normals. For method hr:
    /// whether it links clusters of patches.
    bool clusters = true;
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
    bool total_importance = false;       ///< Whether importance is that of Eq. 9, not of Eq. 10.
    double alpha = 0.1;                  ///< Fraction of rays for importance, Eq. 11; in [0, 1].
    double beta = 0.1;  ///< Fraction of power rays that ignore importance, so all light is sampled; in [0, 1].
};

/// Plan of a run. Settings have the same names in the library, on the command line and in files; see
/// docs/guides/command-line.md.
struct SolveOptions {
    Method method = automatic_method;
    std::vector<WeightedView> views = {};  ///< Views that define importance; without views importance is off.
    /// Limits of the whole run. An iteration cut short by Limits::time is discarded; results then depend on speed.
    Limits limits{.rays = 20'000'000};
    std::uint64_t seed = 1;
    bool keep_direct = false;  ///< Keeps direct light apart, in Solution::direct; 24 bytes per element and light group.
    RefinementOptions refinement = {};
    ImportanceOptions importance = {};
    ExperimentalOptions experimental = {};
};

/// Changes the settings to the algorithm as published in Prikryl et al. 2000: iterations of one bounce from darkness,
/// of which 10 warm up and 100 of equal size are averaged; refinement by Eq. 14 and 15 with one threshold; importance
/// without smoothing; no shrinkage. Iterations have 1/110 of Limits::rays, or grow if those are unlimited. This is the
/// variant ci+hi; ExperimentalOptions has the others.
void use_published_algorithm(SolveOptions& options);

/// Limits as a user gives them. With any of them, the others are infinite.
struct GivenLimits {
    std::optional<std::int64_t> rays = {};
    std::optional<double> time = {}, until = {};

    bool any() const { return rays || time || until; }
    /// Limits that are not given are infinite.
    Limits limits() const;
};

/// Settings as a user gives them on the command line or as keyword arguments of Python. resolved() computes the
/// defaults that depend on other settings.
struct GivenSettings {
    std::optional<Method> method = {};             ///< Default: default_method() for the views.
    std::optional<ImportanceUse> importance = {};  ///< Default: that of the method.
    GivenLimits limits = {};                       ///< If none is given, the limits of SolveOptions apply.
    /// Whether the preset of the paper applies. `others` then starts from use_published_algorithm().
    bool is_published = false;
    /// ExperimentalOptions::rays_per_iteration. Default: 1/110 of the rays with the preset, otherwise 0.
    std::optional<std::int64_t> rays_per_iteration = {};
    SolveOptions others = {};  ///< Views and all other settings; those above are ignored.
};

/// Computes the plan of a run from the settings that a user gives.
/// @return  Not checked for ranges, as solve() does that.
SolveOptions resolved(const GivenSettings& given);

}  // namespace interflect
