#include "interflect/solver/refinement/oracle_threshold.h"

#include <cmath>

#include "interflect/elements/forest.h"
#include "interflect/solver/importance/importance_weights.h"

namespace interflect::detail {

namespace {

/// Number of rays at which ExperimentalOptions::epsilon is the threshold.
constexpr double rays_at_epsilon = 20e6;

}  // namespace

Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area) {
    const double decay =
        std::pow(rays_at_epsilon / static_cast<double>(rays), so_far.options.experimental.epsilon_decay);
    Oracle oracle;
    oracle.refines = true;
    oracle.by_importance = importance_use(so_far) != ImportanceUse::off;
    oracle.threshold = so_far.options.experimental.epsilon * decay * reference_power(so_far);
    if (oracle.by_importance) {
        // Smooth the importance, because underestimated importance would leave elements coarse.
        oracle.importance = smoothed_importance(*so_far.forest, importance_of(so_far),
                                                so_far.options.importance.smoothing, /*exponent=*/1);
        oracle.threshold *= reference_importance(so_far, oracle.importance);
    }
    oracle.min_area = static_cast<float>(min_area);
    oracle.max_elements = so_far.options.refinement.max_elements;
    return oracle;
}

double reference_power(const Solution& so_far) {
    const ElementForest& forest = *so_far.forest;
    if (so_far.view_importance.empty()) return channel_sum(so_far.emitted_power) / 3;
    double mean_irradiance = 0;  // mean of the pictures, because V sums to 1 [lm/m^2 or W/m^2]
    double visible_area = 0;     // [m^2]
    for (PatchIndex i{0}; i < forest.patch_count(); ++i) {
        if (!(so_far.view_importance[i] > 0)) continue;
        mean_irradiance += static_cast<double>(so_far.view_importance[i]) * forest.area(i) *
                           channel_sum(RgbD(so_far.irradiance[i])) / 3;
        visible_area += forest.area(i);
    }
    return mean_irradiance > 0 ? mean_irradiance * visible_area : channel_sum(so_far.emitted_power) / 3;
}

double reference_importance(const Solution& so_far, const std::vector<float>& psi) {
    const ElementForest& forest = *so_far.forest;
    double sum = 0, area = 0;
    for (PatchIndex i{0}; i < forest.patch_count(); ++i) {
        if (!(so_far.view_importance[i] > 0)) continue;
        sum += static_cast<double>(psi[i]) * forest.area(i);
        area += forest.area(i);
    }
    return area > 0 ? sum / area : 0;
}

}  // namespace interflect::detail
