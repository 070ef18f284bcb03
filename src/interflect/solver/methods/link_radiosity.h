#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/iteration_method.h"
#include "interflect/solver/methods/exchange.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// 36 bytes each: they fit the memory of a common computer.
inline constexpr std::size_t most_links = std::size_t{1} << 27;

/// Two elements that exchange light.
struct Link {
    ElementPair ends;
    Exchange exchange;

    /// Exchange with occlusion, A_a F_ab = A_b F_ba [m^2].
    RgbD area() const { return RgbD(exchange.transmittance) * static_cast<double>(exchange.area); }
    /// The same for importance, one number.
    double mean_area() const { return channel_sum(area()) / 3; }
};

/// Two elements that are to be linked.
struct LinkCandidate {
    ElementPair ends;
    Effort effort;
};

struct RefinementCandidate;

/// Solves Eq. 1 of Prikryl et al. 2000 without chance: hierarchical radiosity, Hanrahan, Salzman and Aupperle 1991.
/// Pairs of elements that face each other are linked, and each gathers light over its links; form factors are
/// integrals (exchange.h), only visibility is sampled. A link is replaced by four, to the children of one of its
/// elements, where the bound on its error exceeds epsilon times the reference power of transport_steps.h. The bound is
/// rho_i B_j A_i times that on the error of F_ij: all of F_ij in Hanrahan's 'BF refinement'; here, after Smits, Arvo
/// and Salesin 1992, its variation over an element, and all of it where the pair is partly occluded. Each sweep gathers
/// one bounce over all links and ends with push-pull; whenever light has settled the links are refined, so that no mesh
/// is made for light that is yet to come.
///
/// The transmittance of panes is a property of each link. If it varies by v between the lines of sight, the bound on
/// the error includes the share v of the unoccluded exchange.
///
/// With importance (Smits et al.), psi travels the same links backwards, so that sum v P = sum psi W holds on any mesh,
/// and the error bound is weighted by psi_i / psi_max as in Eq. 15.
///
/// An independent check of the Monte Carlo methods: it has discretisation error and, from its sampled visibility,
/// little noise. Its error follows the mesh: largest in the smallest elements, along edges where surfaces meet, where
/// many links that each are good enough err the same way. Meant for some thousands of patches: all pairs are looked at.
///
/// The run ends when a sweep changes nearly nothing and no link asks for refinement. Refinement stays within
/// options.limits.rays (the first links are made at any price), max_elements and min_area;
/// options.experimental.iterations, if not 0, and seconds limit the sweeps. Options of random sampling, and `until`,
/// have no meaning here. IterationReport has one entry a sweep; `rays` are those of visibility, `escaped_power` is what
/// left the surfaces and arrived at none: in a closed scene the error of the form factors' sum, of either sign.
/// Solution::standard_error and ::rays are 0. Same seed, same bits, for any number of threads. Cost: O(patches^2 +
/// links) time.
class LinkedElements : public IterationMethod {
  public:
    /// @param state       Must outlive this. @param link_limit  Most links at a time.
    explicit LinkedElements(SolverState& state, std::size_t link_limit = most_links);

    /// Links all patches that face each other. @throws InputError where there would be too many links.
    void prepare(SolverState& state) override;
    bool is_fulfilled(const SolverState& state) const override;
    /// Another sweep, until light and links have settled.
    IterationPlan plan(SolverState& state) override;
    /// A sweep: refines the links if light had settled, then carries light, and importance, one bounce further.
    /// @throws InputError as prepare().
    RgbD iterate(SolverState& state, IterationPlan& plan) override;
    void finish(SolverState& state) const override;
    void retarget(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool fits(const SolverState& state) const override;

  private:
    RgbD gather_light();
    void gather_importance();
    bool refine();
    void find_patches_to_link();
    void link_candidates();
    void subdivide_links();
    void require_room_for(std::size_t more) const;
    std::vector<RefinementCandidate> refinement_candidates() const;
    bool may_divide(std::uint32_t element) const;
    void keep_affordable(std::vector<RefinementCandidate>& candidates) const;
    void describe_new_elements(std::uint32_t first);

    SolverState& state_;
    ElementForest& forest_;
    ExchangeEstimator estimator_;
    std::size_t link_limit_;
    std::vector<Link> links_;
    std::vector<LinkCandidate> candidates_;            // that are not links yet
    double light_change_ = 0, importance_change_ = 0;  // of the last sweep
    std::int64_t rays_ = 0;
    int sweeps_ = 0;
    bool refines_ = false;  // there may be links to refine, once light has settled
    bool refines_next_ = false, is_settled_ = false;
};

}  // namespace interflect::inline detail
