#pragma once

#include <cstddef>

#include "interflect/solver/solve.h"

namespace interflect {

/// More links than this would not fit: 16 bytes each.
inline constexpr std::size_t most_links = std::size_t{1} << 27;

/// Solves Eq. 1 of Prikryl et al. 2000 without chance: hierarchical radiosity, Hanrahan, Salzman and Aupperle 1991.
/// Pairs of elements that face each other are linked, and what one receives it gathers over its links; form factors are
/// integrals (see exchange.h), only visibility is sampled. A link that carries too much, rho_i B_j A_i F_ij > epsilon
/// times the reference power of steps.h (either way, the largest channel), is replaced by links to the four children of
/// the larger of its elements: 'BF refinement'. Where part of a link is hidden, it counts as more than it carries.
/// Each sweep gathers one bounce over all links, then push-pull; whenever the light has settled, links are refined, so
/// that the mesh is made for nearly converged light (Hanrahan's multigridding).
///
/// With importance (Smits, Arvo and Salesin 1992), psi is gathered over the same links backwards, which makes
/// sum v P = sum psi W hold on any mesh, and what a link carries is weighted by psi_i / psi_max as in Eq. 15.
///
/// Deterministic, hence the independent check of the methods that cast dice: its error is not noise but what the mesh
/// smooths away and the few lines of sight miss. Meant for up to some thousands of patches: all pairs that face each
/// other are looked at. IterationReport has one entry a sweep; `rays` are rays of visibility, `escaped_power` is what
/// left the surfaces and arrived at none, in a closed scene the error of the sum of form factors, of either sign.
/// Solution::standard_error and ::rays are 0.
///
/// The run ends when a sweep changes nearly nothing and no link asks for refinement. Refinement stays within
/// options.rays (the first links are made at any price), most_elements and smallest_area; options.iterations, if not 0,
/// and seconds limit the sweeps. Options of random sampling, and `until`, have no meaning here.
/// @param scene, options  As solve() accepts them. options.method says whether the mesh is refined and what steers.
/// @param link_limit      Most links at a time.
/// @throws InputError where there would be more links. Same seed, same bits, for any number of threads.
/// Cost: O(patches^2 + links) time, 16 bytes a link.
Solution solve_by_links(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                        const Monitor& monitor = {}, std::size_t link_limit = most_links);

}  // namespace interflect
