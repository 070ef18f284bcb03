/// @file
/// Solves a scene in one call; solver.h does it step by step.
#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"
#include "interflect/solve_options.h"

namespace interflect {

/// Solves Eq. 1 of Prikryl et al. 2000 for the irradiance of every element. Each iteration shoots N rays, sampled by
/// power (Eq. 3) or by power and importance (Eq. 9-11), refines the mesh if the method supports it (Eq. 14, 15), and is
/// merged with the running mean (Eq. 6).
/// @param ray_caster  Of the same scene.
/// @throws InputError listing every option out of range and every fault of the scene; also for a ray caster of another
///         scene and for a view that defines no picture. A scene without light is valid.
Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
               const Monitor& monitor = {});

}  // namespace interflect
