#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/methods/links/cluster_exchange.h"
#include "interflect/solver/methods/links/exchange.h"
#include "interflect/solver/methods/links/first_links.h"
#include "interflect/solver/methods/links/patch_tree.h"

namespace interflect::detail {

/// Maximum number of links, which take 4.5 GiB.
inline constexpr std::size_t max_links = std::size_t{1} << 27;

struct Link {
    ElementPair ends;
    Exchange exchange;

    /// Exchange with occlusion, A_a F_ab = A_b F_ba [m^2].
    RgbD area() const { return RgbD(exchange.transmittance) * static_cast<double>(exchange.area); }
    /// Returns the mean of area() over the channels, for importance.
    double mean_area() const { return channel_sum(area()) / 3; }
};

struct RefinementCandidate;

/// Hierarchical radiosity (Hanrahan et al. 1991) for Eq. 1, Prikryl et al. 2000; deterministic. A sweep gathers one
/// bounce. Only visibility is sampled. With ExperimentalOptions::clusters, scenes of many patches have links between
/// clusters (Smits et al. 1994; ClusterExchange).
///
/// Links to the four children of one end, or to the two parts of a cluster, replace a link if its error bound exceeds
/// epsilon times reference_power(). The bound is rho_i B_j A_i times the variation of F_ij over an element, including
/// partial occlusion. With importance, it is weighted by psi_i / psi_max (Eq. 15; Smits et al. 1992).
///
/// The run ends when light and links have settled. It stays within limits.rays (except for the first links),
/// max_elements and min_area; `until` has no effect. Reported rays are visibility rays. In a closed scene,
/// escaped_power is the error of the form factors. Cost: O(patches^2 + links), with clusters about
/// O(patches log(patches) + links); the cost of a sweep is the number of members of all links.
class LinkedElements : public IterationMethod {
  public:
    /// The state must outlive this.
    explicit LinkedElements(SolverState& state, std::size_t link_limit = max_links);

    /// @throws InputError for too many links.
    void prepare(SolverState& state) override;
    bool is_fulfilled(const SolverState& state) const override;
    IterationPlan plan(SolverState& state) override;
    /// Refines links if the light has settled, then gathers one bounce. @throws InputError as prepare() does.
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState&, const Estimate&, const TracedIteration&) override {}  // a sweep replaces the light
    void finish(SolverState& state) const override;
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override;

  private:
    RgbD gather_light();
    void gather_importance();
    bool refine_links();
    void find_first_links();
    Exchange estimate(const LinkCandidate& candidate, std::int64_t& rays) const;
    void link_candidates();
    void subdivide_links();
    void require_room_for(std::size_t more) const;
    std::vector<RefinementCandidate> refinement_candidates() const;
    ElementIndex divided_end(const ElementPair& ends, double over_a, double over_b) const;
    bool may_divide(ElementIndex end) const;
    void keep_affordable(std::vector<RefinementCandidate>& candidates) const;
    void initialise_new_elements(std::uint32_t first);

    SolverState& state_;
    ElementForest& forest_;
    ExchangeEstimator estimator_;
    PatchTree tree_;
    ClusterExchange clusters_;
    std::size_t link_limit_;
    std::vector<Link> links_;
    std::vector<LinkCandidate> candidates_;
    double light_change_ = 0, importance_change_ = 0;  // relative changes in the last sweep
    std::int64_t rays_ = 0;
    int sweeps_ = 0;
    bool refines_ = false;
    bool refines_next_ = false;  // whether the next iteration starts with refine_links()
    bool is_settled_ = false;
};

}  // namespace interflect::detail
