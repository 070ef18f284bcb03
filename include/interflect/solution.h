/// @file
/// The result of a run: irradiance, importance and errors of the elements; its mesh, power balance, dimming and files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/ranks.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect {

namespace detail {
class ElementForest;
}

/// State of a run after an iteration. Counts since the start.
struct IterationReport {
    int iteration = 0;  ///< 0 is the preparation of the run, if any.
    double seconds = 0;
    std::int64_t rays = 0;        ///< Sum of the two below; in a combined iteration every ray carries both.
    std::int64_t power_rays = 0;  ///< Rays sampled by power.
    std::int64_t importance_rays =
        0;  ///< Rays sampled by importance; combined iterations split their rays in proportion.
    std::int64_t escaped_rays = 0;
    std::uint32_t elements = 0, leaves = 0;
    RgbD total_power{0, 0, 0};    ///< Sum of P [lm or W].
    RgbD escaped_power{0, 0, 0};  ///< Power lost through openings, averaged as irradiance is [lm or W].
    /// Estimated relative error: root of the sum of squares of noise and discretisation. With a view: root mean square
    /// over the picture, relative to the mean, for visible reflected luminance without emission. Without: the same for
    /// irradiance, over the area. Infinite before an estimate exists, and if a view shows no reflected light.
    double error_estimate = std::numeric_limits<double>::infinity();
    double noise_estimate = std::numeric_limits<double>::infinity();  ///< Standard error.
    /// Mean deviation within elements. 0 where it is not estimated: on fixed elements, and where another criterion than
    /// the variance refines them. `error_estimate` then equals `noise_estimate`.
    double discretisation_estimate = std::numeric_limits<double>::infinity();
    /// Payload of a ray relative to the mean of all rays: maximum, and value exceeded by 0.1% of the rays.
    double largest_payload = 1, high_payload = 1;
    /// Share of all hits whose positions refinement has lost; method photon-mesh only. Not in the history of solution
    /// files.
    double discarded_hits = 0;
};

struct IterationTraffic {
    int iteration = 0;
    std::vector<Ranks::Traffic> of_ranks;  ///< Traffic of each rank since the last iteration.
};

/// Solution and history of a run. Vectors have one entry per element of the forest; inner elements hold the mean of
/// their children.
struct Solution {
    std::shared_ptr<const detail::ElementForest> forest;  ///< Quadtrees of the elements, opaque; see leaves().
    std::vector<Rgb> irradiance;                          ///< Irradiance H [lm/m^2 or W/m^2].
    /// H before noise reduction [as H]. Paths of hybrid shading and of final gathering end at it: noise
    /// reduction moves light from bright to dark elements, which biases means over the visible ones. Empty if equal to
    /// `irradiance`.
    std::vector<Rgb> unreduced_irradiance;
    /// Parts of H by light group, [group][element]; they sum to H. Empty without light groups.
    std::vector<std::vector<Rgb>> groups;
    /// Part of H that comes straight from sources, by light group as `groups`, or in one entry without groups; their
    /// sum is at most H. Empty without SolveOptions::keep_direct.
    std::vector<std::vector<Rgb>> direct;
    std::vector<std::string> group_names;  ///< As in source_groups(scene).
    /// Remaining scale factor of each group's sources: 1, except in files of Solver::save(), whose scene is not dimmed.
    std::vector<float> dimming;
    /// Largest channel of M + H of each patch before dim() [as H]; empty if not dimmed. Exports choose the faces that
    /// they show from it, so that all dimmed states have the same faces.
    std::vector<float> undimmed_light;
    std::vector<float> view_importance;       ///< View importance v [1/m^2]; empty without a view.
    std::vector<float> indirect_importance;   ///< Indirect importance psi - v [1/m^2]; empty without a view.
    std::vector<float> standard_error;        ///< Estimated standard error of the luminance of H [as H].
    std::vector<float> discretisation_error;  ///< Estimated deviation of H within the element from its mean [as H].
    std::vector<float> rays;                  ///< Number of rays started on the element.
    SolveOptions options;
    std::vector<IterationReport> iterations;
    /// Traffic of iterations by several processes; not in solution files and checkpoints.
    std::vector<IterationTraffic> traffic;
    RgbD emitted_power{0, 0, 0};  ///< Power of all sources [lm or W].
    std::int64_t non_finite = 0;  ///< Non-finite radiosities, which are not shot; 0 in a correct run.
    bool interrupted = false;     ///< Whether the caller stopped the run before a limit was reached.
};

/// A leaf of the mesh: a patch that is not divided, or a piece of one.
struct Leaf {
    ElementIndex element{};  ///< Index into the vectors of Solution.
    PatchIndex patch{};      ///< Index into Scene::patches.
    int level = 0;           ///< Number of divisions of the patch; 0: the patch itself.
    int vertex_count = 4;    ///< 3 or 4.
    /// World coordinates [m], counter-clockwise seen from the lit side. A triangle repeats the last.
    std::array<Imath::V3d, 4> vertices{};
    float area = 0;                  ///< Area [m^2].
    Rgb irradiance{0, 0, 0};         ///< Irradiance H [lm/m^2 or W/m^2].
    Rgb direct{0, 0, 0};             ///< Part of H straight from sources; 0 without SolveOptions::keep_direct [as H].
    float importance = 0;            ///< Importance psi, all bounces; 0 without a view [1/m^2].
    float standard_error = 0;        ///< As Solution::standard_error.
    float discretisation_error = 0;  ///< As Solution::discretisation_error.
};

/// Returns the mesh of a solution, with one entry per leaf, in the order of the elements. Cost: O(elements).
/// @throws InputError for a solution of another scene.
std::vector<Leaf> leaves(const Scene& scene, const Solution& solution);

/// Balance of the emitted power, per channel [lm or W].
struct PowerBalance {
    RgbD emitted{0, 0, 0};   ///< Power emitted by surfaces, and by luminaires into the scene.
    RgbD absorbed{0, 0, 0};  ///< Absorbed power: sum of (1 - rho - tau) H A, with H from the solution.
    RgbD escaped{0, 0, 0};   ///< Power lost through openings, averaged as irradiance is.

    /// Unaccounted power, relative to emitted power, summed over all channels; 0 without emission.
    double relative_difference() const;
};

/// Computes the power balance of a solution. The difference contains the noise of averaged iterations. Cost:
/// O(elements).
PowerBalance power_balance(const Scene& scene, const Solution& solution);

/// Scales the sources of a light group and all of its light, without tracing rays; the result equals a solution of the
/// dimmed scene. Errors and importance are unchanged.
/// @param factor  Relative to the current emission; >= 0.
/// @throws InputError that lists the groups, for an unknown group; for a factor that is negative or not finite.
void dim(Scene& scene, Solution& solution, const std::string& group, float factor);

/// A solved scene, complete for rendering.
struct SolvedScene {
    Scene scene;
    Solution solution;  ///< From a file: iterations lack their times; before version 5, all but the last are missing.
    int format_version = 0;          ///< Format version of the file read.
    std::string interflect_version;  ///< Program version that wrote the file; empty if not recorded.
};

/// Writes scene and solution as one HDF5 file (layout in docs/files/solution-file.md), with a report of every iteration
/// and checksums of every byte. Equal input gives equal bytes.
/// @throws std::runtime_error if the file cannot be written; before writing, if the scene has a fault, or a quantity is
///         negative, not finite or not one per element. Every written file is therefore readable.
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution);

/// Reads files of write_solution() and of format versions 2 to 5. Searches missing Scene::files in the folder of the
/// solution.
/// @throws InputError for a file that is missing, damaged or of another kind.
SolvedScene read_solution(const std::filesystem::path& path);

/// Returns whether the file starts like a solution file of this or an older version; false if it cannot be read. Also
/// true for a current file with damaged first bytes.
bool is_solution_file(const std::filesystem::path& path);

}  // namespace interflect
