/// @file
/// The whole library. From files to pictures:
///
///     Scene scene = load_scene("office.mgf");              // load.h, scene.h, light_sources.h
///     for (const Finding& f : validate(...)) ...           // prepare.h: faults that would spoil the light
///     scene = cut_at_contacts(scene);                      // prepare.h: light does not leak below walls
///     const RayCaster ray_caster(scene);                   // ray_caster.h
///     SolveOptions options;                                // solve_options.h: method, views, limits
///     options.views = {{scene.views[0]}};
///     const Solution solution = solve(scene, ray_caster, options);    // solve.h; step by step: Solver in solver.h
///     for (const Leaf& leaf : leaves(scene, solution)) ... // solution.h: irradiance and errors of the mesh; files
///     find_escapes(scene, ray_caster, solution);           // leaks.h: light that leaves the scene through gaps
///     render(scene, solution, ray_caster, scene.views[0]); // render.h, shading.h; image.h writes files
///     preview(scene, solution, ray_caster, scene.views[0]).image;     // preview.h: a rough picture in a second
///     denoise(rendering.layers).image;                     // denoise.h: filters against the noise of pictures
///     compare(image, reference).flip;                      // metrics.h: differences of pictures
///     measure_irradiance(...);                             // measure.h: lux at points and grids, glare, probes
///     export_solution("office.glb", scene, solution);      // export.h: lit glTF, lightmaps, other renderers
///     view_factors(scene, ray_caster, object_groups(scene));          // view_factors.h: exchange of radiation
///
/// Lengths are in metres, colours linear Rec. 709, light in photometric or radiometric units, as the scene has them.
/// Wrong input causes an InputError that lists every fault (core.h). The same seed gives the same bits for any number
/// of threads. Objects are values; const functions may be called from several threads.
#pragma once

#include "interflect/core.h"
#include "interflect/denoise.h"
#include "interflect/export.h"
#include "interflect/generate.h"
#include "interflect/image.h"
#include "interflect/leaks.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"
#include "interflect/measure.h"
#include "interflect/metrics.h"
#include "interflect/plots.h"
#include "interflect/prepare.h"
#include "interflect/preview.h"
#include "interflect/rates.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/shading.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "interflect/solve_options.h"
#include "interflect/solver.h"
#include "interflect/summary.h"
#include "interflect/view_factors.h"
