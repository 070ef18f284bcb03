#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/deposit/contribution_units.h"
#include "interflect/solver/deposit/descent.h"
#include "interflect/solver/deposit/transport_step.h"
#include "interflect/solver/light/materials.h"

namespace interflect::detail {

/// Power that a leaf has received and will reflect.
struct ReflectedPower {
    ElementIndex leaf;
    PatchIndex patch;
    Parameters at;  ///< Point at which the leaf received it.
    RgbD power;     ///< Received power [lm or W].
    double of_ray;  ///< Power of the ray before any pane, sum of the channels.
};

/// Particles of one task. Each thread has its own object.
struct Walkers {
    std::vector<ReflectedPower> received, reflected;
    std::vector<RgbD> received_groups, reflected_groups;  ///< [particle][group]
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Panes::HitBehind> behind;
    std::vector<std::int64_t> group_terms;
    PointBlock points;
};

/// Random walks that complete a pass (TransportStep::completes_by_walks). The survival probability includes the
/// transmittance of crossed panes. Otherwise rays with several deposits would multiply the particles.
class Walks {
  public:
    /// @param elements  Size of the forest before the step. Ancestors receive the light of newer elements.
    Walks(const Materials& materials, const ElementForest& forest, const RayCaster& ray_caster, const Panes& panes,
          const TransportStep& step, const ContributionUnits& units, std::uint32_t elements, std::uint64_t key);

    /// Adds a received particle. The caller must append its power by light group, after panes, to `received_groups`.
    /// @param power          Power before any pane.
    /// @param transmittance  Transmittance of the panes before the hit.
    void add(const Ray& ray, const Hit& hit, const RgbD& power, const Rgb& transmittance, Walkers& walkers) const;
    /// Traces the walks to their end. @param task  Key of the random numbers.
    void follow(std::uint64_t task, Walkers& walkers, Descent& descent) const;

  private:
    void survive(double offset, Walkers& walkers) const;
    void shoot(std::uint64_t key, Walkers& walkers) const;
    void receive(Walkers& walkers, Descent& descent) const;
    void deposit(const Ray& ray, const Hit& hit, const Rgb& transmittance, std::size_t walker, Walkers& walkers,
                 Descent& descent) const;

    const Materials& materials_;
    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    const Panes& panes_;
    const TransportStep& step_;
    const ContributionUnits& units_;
    std::uint32_t elements_;
    std::uint64_t key_;
};

}  // namespace interflect::detail
