#include "interflect/solution.h"

#include "interflect/elements/forest.h"
#include "interflect/solver/light/materials.h"

namespace interflect {

using namespace detail;

double PowerBalance::relative_difference() const {
    const double all = channel_sum(emitted);
    return all > 0 ? channel_sum(absorbed + escaped - emitted) / all : 0;
}

PowerBalance power_balance(const Scene& scene, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    forest.require_made_for(scene);
    Materials materials(scene);
    materials.grow(forest);
    PowerBalance balance;
    balance.emitted = solution.emitted_power;
    if (!solution.iterations.empty()) balance.escaped = solution.iterations.back().escaped_power;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!forest.is_leaf(e)) continue;
        const PatchIndex patch = forest.patch(e);
        const MeanSurface surface = materials.surface(patch, e);
        const RgbD kept = RgbD(1) - RgbD(surface.reflectance + surface.transmittance);
        balance.absorbed += kept * RgbD(solution.irradiance[e]) * static_cast<double>(forest.area(e));
    }
    return balance;
}

}  // namespace interflect
