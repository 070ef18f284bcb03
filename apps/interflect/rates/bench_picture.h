#pragma once

#include <CLI/CLI.hpp>

#include "apps/interflect/values/parse.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/render.h"
#include "interflect/solve_options.h"

namespace interflect::command {

/// Options of `bench --picture`.
struct PictureBenchOptions {
    bool is_given = false;
    Shading shading = Shading::hybrid;
    Size size{640, 360};
    int samples = 0;  ///< Camera rays per pixel; 0 for the default of `render`.

    void add_to(CLI::App& command);
};

/// Measures the ray rate of a picture of the first view, and of Embree alone with the same rays. Draws the picture once
/// to record its rays, then in every round.
/// @param solve_options  At most `limits.rays` rays are traced for the solution, and recorded.
detail::Json bench_picture(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& solve_options,
                           const PictureBenchOptions& options, int rounds);

/// @param figures  Result of bench_picture().
void print_picture(const detail::Json& figures);

}  // namespace interflect::command
