/// @file
/// Measures the ray rates of the solver, of pictures and of Embree alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Rates of Embree alone: rays prepared in its own layout, on all threads.
struct EmbreeRates {
    /// Names of the interfaces of Embree, in the order of `by_interface`.
    static constexpr std::array<const char*, 4> names{"single", "packet8", "packet16", "stream"};
    std::array<double, 4> by_interface{};  ///< [rays/s]

    double ceiling() const { return *std::max_element(by_interface.begin(), by_interface.end()); }  ///< [rays/s]
};

/// One measurement of the solver.
struct SolverRates {
    EmbreeRates embree;  ///< Rates of Embree for the rays of an iteration.
    double solver = 0;   ///< [rays/s]
    /// Shares of the solver's time, each measured alone: generating rays, tracing, finding the hit leaves, and choosing
    /// elements with the oracle.
    double making_rays = 0, tracing = 0, receiving = 0, refinement = 0;

    /// Share of the remaining time: work per element of every iteration.
    double sweeps() const { return std::max(0.0, 1 - making_rays - tracing - receiving - refinement); }
};

struct SolverMeasurement {
    std::size_t elements = 0;
    std::vector<SolverRates> rounds;
};

/// Solves a scene, then measures a step of transport with its light and mesh, and the whole run, in every round. A
/// round measures everything, since the speed of a machine changes with its load.
/// @param options  With Limits::rays, which is also the number of rays of the step.
/// @param rounds   > 0.
/// @throws InputError for a scene without light, and as solve() does.
SolverMeasurement measure_solver(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                                 int rounds);

struct PictureMeasurement {
    struct Round {
        double seconds = 0;
        EmbreeRates embree;  ///< Rates of Embree for the recorded rays.
    };
    std::int64_t rays = 0;                         ///< Number of rays of the picture.
    std::size_t recorded = 0;                      ///< Number of these rays that were recorded.
    double camera = 0, reflected = 0, shadow = 0;  ///< Shares of the rays by kind.
    std::vector<Round> rounds;
};

/// Draws a picture once to record its rays, then in every round.
/// @param solution   Null for a shading without a solution.
/// @param max_rays   Maximum number of recorded rays, > 0.
/// @param rounds     > 0.
/// @throws InputError as render() does.
PictureMeasurement measure_picture(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                   const View& view, const PictureOptions& options, std::int64_t max_rays, int rounds);

}  // namespace interflect
