#include "interflect/solver/error/error_weight.h"

#include <algorithm>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

ErrorMeasure default_measure(const LightState& light) {
    return light.solution.view_importance.empty() ? ErrorMeasure::surfaces : ErrorMeasure::pictures;
}

double error_weight(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex element) {
    if (measure == ErrorMeasure::surfaces) return 1;
    if (light.solution.view_importance[element] == 0) return 0;
    const Rgb rho = inputs.materials.reflectance(light.forest->patch(element), element);
    Rgb h = light.solution.irradiance[element];
    for (int c = 0; c < 3; ++c) h[c] = std::max(0.0f, h[c]);  // noisy differences may sum to a negative value
    const float all = luminance(h), reflected = luminance(Rgb(rho * h));
    const float factor = all > 0 ? reflected / all : luminance(rho);
    return static_cast<double>(light.solution.view_importance[element]) * factor * factor;
}

double error_reference(const RunInputs& inputs, const LightState& light, ErrorMeasure measure) {
    const ElementForest& forest = *light.forest;
    const bool of_pictures = measure == ErrorMeasure::pictures;
    struct Sums {
        double light = 0, weight = 0;
        Sums& operator+=(const Sums& o) { return light += o.light, weight += o.weight, *this; }
    };
    const Sums sums = parallel_sum(forest.size(), elements_per_task, Sums(), [&](std::size_t begin, std::size_t end) {
        Sums sum;
        for (ElementIndex e(begin); e < end; ++e) {
            if (of_pictures && light.solution.view_importance[e] == 0) continue;
            if (!forest.is_leaf(e)) continue;
            const double w =
                forest.area(e) * (of_pictures ? static_cast<double>(light.solution.view_importance[e]) : 1.0);
            const Rgb& h = light.solution.irradiance[e];
            const Rgb& rho = inputs.materials.reflectance(forest.patch(e), e);
            sum.light += w * luminance(of_pictures ? Rgb(rho * h) : h);
            sum.weight += w;
        }
        return sum;
    });
    // View importance sums to 1 over first hits; surfaces behind panes only add light.
    return of_pictures ? sums.light : sums.light / sums.weight;
}

}  // namespace interflect::detail
