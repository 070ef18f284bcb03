#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/base/points.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// What to compute and when to stop. The run ends at the first limit that is reached.
struct SolveOptions {
    std::int64_t rays = 20'000'000;  ///< Most rays to trace in all; > 0.
    double seconds =
        std::numeric_limits<double>::infinity();  ///< Most time to take [s]; > 0. Bits then depend on speed.
    double until = 0;  ///< Stop at this estimated relative error (see IterationReport); 0: never. In [0, 1).
    std::uint64_t seed = 1;
    PointSet points = PointSet::sobol;

    /// The first estimate: true: light is followed bounce by bounce, each time only what has not been shot yet, until
    /// 0.1% of the emitted power is left (all rays count). False: the paper's, from darkness through warm_up
    /// iterations.
    bool incremental_start = true;
    int warm_up = 0;     ///< Iterations with tau = 1 before averaging begins; >= 0.
    int iterations = 0;  ///< Averaged iterations; 0: as many as the limits allow. >= 0.
    /// Rays of each iteration; 0: begins small and grows with the rays already averaged. >= 0.
    std::int64_t rays_per_iteration = 0;
};

/// Where a run stands after an iteration; counts since its start.
struct IterationReport {
    int iteration = 0;  ///< 0 is the incremental start, where there is one.
    double seconds = 0;
    std::int64_t rays = 0;
    std::int64_t escaped_rays = 0;
    RgbD total_power{0, 0, 0};    ///< Sum of P [lm or W].
    RgbD escaped_power{0, 0, 0};  ///< What this iteration lost through the openings of the scene [lm or W].
    /// Estimated relative standard error of the irradiance: root of its area-weighted mean square over the patches,
    /// over the area-weighted mean irradiance; luminance. From the spread of independent iterations about their running
    /// mean (ErrorEstimate in schedule.h); infinite while only one is there.
    double error_estimate = std::numeric_limits<double>::infinity();
};

/// The light on the surfaces, and how it was found.
struct Solution {
    std::vector<Rgb> irradiance;  ///< H of each patch [lm/m^2 or W/m^2].
    std::string method = "srr";
    SolveOptions options;
    std::vector<IterationReport> iterations;
    RgbD emitted_power{0, 0, 0};  ///< Sum of W [lm or W].
    std::int64_t non_finite = 0;  ///< Non-finite powers met (and not shot); 0 unless something is wrong.
    bool interrupted = false;     ///< Stopped by the caller before any limit was reached.
};

/// How a caller follows a run, and ends it early.
struct Monitor {
    std::function<void(const IterationReport&)> report;  ///< After each iteration, on the calling thread; may be empty.
    const std::atomic<bool>* stop = nullptr;             ///< Once true, the run ends after the iteration under way.
};

/// Solves Eq. 1 of Prikryl et al. 2000 for the irradiance of every patch by stochastic ray radiosity (Neumann et al.
/// 1995): each iteration shoots N rays, chosen by power (Eq. 3), and is merged with the past (Eq. 6).
/// @throws InputError listing every option out of range and every fault of the scene. A scene without light is legal.
Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
               const Monitor& monitor = {});

}  // namespace interflect
