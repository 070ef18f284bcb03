#pragma once

#include <cstddef>

#include "interflect/solver/solve.h"

namespace interflect {

/// As many as fit the memory of a common computer: 24 bytes each.
inline constexpr std::size_t most_links = std::size_t{1} << 27;

/// Solves Eq. 1 of Prikryl et al. 2000 without chance: hierarchical radiosity, Hanrahan, Salzman and Aupperle 1991.
/// Pairs of elements that face each other are linked, and each gathers light over its links; form factors are
/// integrals (exchange.h), only visibility is sampled. A link is replaced by four, to the children of one of its
/// elements, where the bound on its error exceeds epsilon times the reference power of steps.h. The bound is
/// rho_i B_j A_i times that on the error of F_ij: all of F_ij in Hanrahan's 'BF refinement'; here, after Smits, Arvo
/// and Salesin 1992, its variation over an element, and all of it where the pair is partly occluded. Each sweep gathers
/// one bounce over all links and ends with push-pull; whenever light has settled the links are refined, so that no mesh
/// is made for light that is yet to come.
///
/// With importance (Smits et al.), psi travels the same links backwards, so that sum v P = sum psi W holds on any mesh,
/// and the error bound is weighted by psi_i / psi_max as in Eq. 15.
///
/// An independent check of the Monte Carlo methods: it has discretisation error and, from its sampled visibility,
/// little noise. Its error follows the mesh: largest in the smallest elements, along edges where surfaces meet, where
/// many links that each are good enough err the same way. Meant for some thousands of patches: all pairs are looked at.
///
/// The run ends when a sweep changes nearly nothing and no link asks for refinement. Refinement stays within
/// options.rays (the first links are made at any price), max_elements and min_area; options.iterations, if not 0,
/// and seconds limit the sweeps. Options of random sampling, and `until`, have no meaning here. IterationReport has one
/// entry a sweep; `rays` are those of visibility, `escaped_power` is what left the surfaces and arrived at none: in a
/// closed scene the error of the form factors' sum, of either sign. Solution::standard_error and ::rays are 0.
/// @param scene, options  As solve() accepts them. options.method says whether the mesh is refined and what steers.
/// @param link_limit      Most links at a time.
/// @throws InputError where there would be more links. Same seed, same bits, for any number of threads.
/// Cost: O(patches^2 + links) time.
Solution solve_by_links(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options,
                        const Monitor& monitor = {}, std::size_t link_limit = most_links);

}  // namespace interflect
