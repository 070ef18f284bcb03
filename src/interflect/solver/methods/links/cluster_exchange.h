#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/methods/links/exchange.h"
#include "interflect/solver/methods/links/patch_tree.h"

namespace interflect::detail {

/// Exchange of a cluster with a cluster or an element, after Smits, Arvo and Greenberg 1994. For members p and q of the
/// two ends, A_p F_pq = T s w_p w_q [m^2]. So the cost of a link is the sum of the numbers of members, not their
/// product. All pairs of a link share one sampled transmittance T.
///
/// If the ends are distant, w_p = A_p cos / |p - c|^2, with the cosine towards the centre c of the other end, and
/// s = |c - c'|^2 / pi with both centres. The relative error is of second order in radius over distance. If an element
/// is near a cluster, w_p = A_p F_p with the form factor F_p to the element by Lambert's formula, and s w_q = 1.
class ClusterExchange {
  public:
    ClusterExchange(const ElementForest& forest, const PatchTree& tree, const ExchangeEstimator& estimator,
                    std::uint64_t seed)
        : forest_(forest), tree_(tree), estimator_(estimator), seed_(seed) {}

    Sphere sphere(ElementIndex end) const;
    /// Returns whether the approximation holds for all members, apart from occlusion.
    bool is_valid(const ElementPair& pair) const;

    /// Computes the exchange and samples its transmittance. Thread-safe.
    /// @param rays  Increased by the number of traced rays.
    Exchange estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const;

    /// Adds the power [W or lm] that each member receives from the other end.
    /// @param leaving  Radiosity of each element.
    template <class T>
    void transport(const ElementPair& pair, const T& transmittance, const std::vector<T>& leaving,
                   std::vector<T>& received) const {
        const Factors factors(*this, pair);
        T from_a(0), from_b(0);
        for (const ClusterMember& p : factors.a.members()) from_a += leaving[p.element] * factors.weight_a(p);
        for (const ClusterMember& q : factors.b.members()) from_b += leaving[q.element] * factors.weight_b(q);
        from_a *= transmittance * factors.scale;
        from_b *= transmittance * factors.scale;
        for (const ClusterMember& p : factors.a.members()) received[p.element] += from_b * factors.weight_a(p);
        for (const ClusterMember& q : factors.b.members()) received[q.element] += from_a * factors.weight_b(q);
    }

  private:
    struct End {
        Sphere sphere;
        ClusterMember element;
        std::span<const ClusterMember> patches;  // members of a cluster; empty for an element

        std::span<const ClusterMember> members() const { return patches.empty() ? std::span(&element, 1) : patches; }
    };
    /// Weight w of a member, from a point or polygon at the other end.
    struct Weight {
        enum class Kind { by_point, by_polygon, one } kind = Kind::one;
        V3f point{0, 0, 0};
        ConvexPolygon polygon;

        double operator()(const ClusterMember& member) const;
    };
    /// Factors of A_p F_pq: the weights of both ends, and the scale s.
    struct Factors {
        End a, b;
        Weight weight_a, weight_b;
        double scale = 1;

        Factors(const ClusterExchange& exchange, const ElementPair& pair);
    };

    End end(ElementIndex end) const;

    const ElementForest& forest_;
    const PatchTree& tree_;
    const ExchangeEstimator& estimator_;
    std::uint64_t seed_;
};

}  // namespace interflect::detail
