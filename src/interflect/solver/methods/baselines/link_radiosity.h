#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/methods/baselines/exchange.h"

namespace interflect::detail {

/// Default limit of links: 4.5 GiB at 36 bytes each.
inline constexpr std::size_t most_links = std::size_t{1} << 27;

/// Two elements that exchange light.
struct Link {
    ElementPair ends;
    Exchange exchange;

    /// Exchange with occlusion, A_a F_ab = A_b F_ba [m^2].
    RgbD area() const { return RgbD(exchange.transmittance) * static_cast<double>(exchange.area); }
    /// Mean of area() over the channels, for importance.
    double mean_area() const { return channel_sum(area()) / 3; }
};

struct LinkCandidate {
    ElementPair ends;
    Effort effort;
};

struct RefinementCandidate;

/// Deterministic solver of Eq. 1 of Prikryl et al. 2000: hierarchical radiosity (Hanrahan, Salzman and Aupperle 1991).
/// Elements that face each other are linked and gather light over their links. Form factors are integrals (exchange.h);
/// only visibility is sampled. A link is replaced by four links to the children of one of its elements if its error
/// bound exceeds epsilon times the reference power (transport_steps.h). The bound is rho_i B_j A_i times a bound on the
/// error of F_ij. In Hanrahan's 'BF refinement', the latter is F_ij itself. Here, after Smits, Arvo and Salesin 1992,
/// it is the variation of F_ij over an element, or F_ij if the pair is partly occluded. Each sweep gathers one bounce
/// over all links and ends with push-pull. Links are refined only when light has settled, so no mesh is made for
/// incomplete light.
///
/// Each link has the transmittance of its panes. If it varies by v between the lines of sight, the error bound includes
/// the share v of the unoccluded exchange.
///
/// With importance (Smits et al.), psi is transported backwards over the same links, so sum v P = sum psi W on any
/// mesh. The error bound is weighted by psi_i / psi_max as in Eq. 15.
///
/// An independent check of the Monte Carlo methods, with discretisation error and, from sampled visibility, little
/// noise. The error is largest in the smallest elements along edges where surfaces meet, because the errors of many
/// good links have the same sign there. Intended for a few thousand patches: all pairs are tested.
///
/// The run ends when a sweep changes almost nothing and no link needs refinement. Refinement stays within
/// options.limits.rays, max_elements and min_area; the first links may exceed the limit of rays.
/// options.experimental.iterations, if not 0, and seconds limit the sweeps. Options of random sampling, and `until`,
/// have no effect. IterationReport has one entry per sweep; its `rays` are visibility rays. `escaped_power` is the
/// power that left the surfaces and reached no other. In a closed scene it is the error of the sum of form factors, of
/// either sign. Solution::standard_error, ::discretisation_error and ::rays are 0. The same seed gives the same bits
/// for any number of threads. Cost: O(patches^2 + links) time.
class LinkedElements : public IterationMethod {
  public:
    /// @param state Must outlive this object.
    /// @param link_limit Maximum number of links at a time.
    explicit LinkedElements(SolverState& state, std::size_t link_limit = most_links);

    /// Links all patches that face each other. @throws InputError if there are too many links.
    void prepare(SolverState& state) override;
    bool is_fulfilled(const SolverState& state) const override;
    /// Plans another sweep until light and links have settled.
    IterationPlan plan(SolverState& state) override;
    /// Performs a sweep: refines the links if light had settled, then transports light and importance by one bounce.
    /// @throws InputError like prepare().
    Estimate trace(SolverState& state, IterationPlan& plan) override;
    void merge(SolverState&, const Estimate&, const IterationPlan&) override {}  // a sweep replaces the light
    void finish(SolverState& state) const override;
    void change_views(SolverState& state) override;
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
    std::vector<LinkCandidate> candidates_;            // not linked yet
    double light_change_ = 0, importance_change_ = 0;  // of the last sweep
    std::int64_t rays_ = 0;
    int sweeps_ = 0;
    bool refines_ = false;  // links may need refinement once light has settled
    bool refines_next_ = false, is_settled_ = false;
};

}  // namespace interflect::detail
