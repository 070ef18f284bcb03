#include "interflect/solver/refinement/visible_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/image/tone/visual_adaptation.h"
#include "interflect/solver/shrinkage/sibling_variation.h"

namespace interflect::detail {

namespace {

// Luminance of the display [cd/m^2]: its white is the default of tone_map(), and its contrast in a lit room is 200.
constexpr float display_white = 100, display_black = 0.5f;
/// Logarithmic mean of a picture, relative to white, after automatic_exposure().
constexpr float mean_over_white = 0.2f;
/// Resolution for the observer of FLIP (docs/method/metrics.md).
constexpr float pixels_per_degree = 67.02f;
/// Frequency of the greatest sensitivity [cycles per degree].
constexpr double best_frequency = 8;
/// Just noticeable difference of a steadily viewed edge, relative to cone_threshold(), which applies to brief flashes.
/// The value was chosen by measurement (docs/method/results.md).
constexpr float jnd_of_edge = 0.2f;

/// Returns the logarithmic mean of reflected light in the pictures [lm/m^2 or W/m^2]; 0 if they are dark.
double logarithmic_mean(const RunInputs& inputs, const LightState& light) {
    struct Sums {
        double stops = 0, weight = 0;
        Sums& operator+=(const Sums& o) { return stops += o.stops, weight += o.weight, *this; }
    };
    const ElementForest& forest = *light.forest;
    const Sums sums = parallel_sum(forest.size(), elements_per_task, Sums(), [&](std::size_t begin, std::size_t end) {
        Sums sum;
        for (ElementIndex e(begin); e < end; ++e) {
            const Rgb rho = inputs.materials.surface(forest.patch(e), e).reflectance;
            const float reflected = luminance(Rgb(rho * light.solution.irradiance[e]));
            if (!forest.is_leaf(e) || !(reflected > 0)) continue;
            const double weight = static_cast<double>(forest.area(e)) * light.solution.view_importance[e];
            sum.stops += weight * std::log2(static_cast<double>(reflected));
            sum.weight += weight;
        }
        return sum;
    });
    return sums.weight > 0 ? std::exp2(sums.stops / sums.weight) : 0;
}

/// Returns the sensitivity relative to its maximum. It is 1 for low frequencies, because the edges of large elements
/// contain all higher frequencies.
float relative_sensitivity(double cycles_per_degree) {
    return static_cast<float>(contrast_sensitivity(std::max(best_frequency, cycles_per_degree)) /
                              contrast_sensitivity(best_frequency));
}

/// Returns the largest share of all pictures that a square degree covers.
double share_of_square_degree(const std::vector<WeightedView>& views) {
    double weight = 0, largest = 0;
    for (const WeightedView& v : views) {
        const double pixels = static_cast<double>(v.aspect) * v.pixel_rows * v.pixel_rows;
        weight += v.weight;
        largest = std::max(largest, v.weight * pixels_per_degree * pixels_per_degree / pixels);
    }
    return largest / weight;
}

}  // namespace

float threshold_elevation(float contrast) {
    const float response = 0.0153f * std::pow(392.5f * contrast, 0.7f);
    return std::pow(1 + std::pow(response, 4.0f), 0.25f);
}

VisibleDifference::VisibleDifference(const RunInputs& inputs, const LightState& light)
    : inputs_(inputs), light_(light) {
    const double mean = logarithmic_mean(inputs, light);
    if (mean > 0) exposure_ = static_cast<float>(static_cast<double>(mean_over_white * display_white) / mean);
    const double contrast =
        jnd_of_edge * cone_threshold(mean_over_white * display_white) / (mean_over_white * display_white);
    share_of_light_ = contrast * share_of_square_degree(light.options().views);
}

/// Returns the mean of the smallest ancestor that covers a square degree, or else of the patch [cd/m^2].
float VisibleDifference::adapted_luminance(ElementIndex leaf, float pixels) const {
    const ElementForest& forest = *light_.forest;
    const PatchIndex patch = forest.patch(leaf);
    ElementIndex e = leaf;
    for (; e != patch && pixels < pixels_per_degree * pixels_per_degree; pixels *= 4) e = forest.parent(e);
    const Rgb rho = inputs_.materials.surface(patch, e).reflectance;
    return std::clamp(exposure_ * luminance(Rgb(rho * light_.solution.irradiance[e])), display_black, display_white);
}

/// Returns the root mean square difference of the leaf and its siblings caused by texture [cd/m^2].
float VisibleDifference::masking_contrast(ElementIndex leaf) const {
    const ElementForest& forest = *light_.forest;
    const PatchIndex patch = forest.patch(leaf);
    if (leaf == patch) return 0;
    const ElementIndex first = first_sibling(forest, leaf), parent = forest.parent(leaf);
    const auto rho = [&](ElementIndex e) { return luminance(inputs_.materials.surface(patch, e).reflectance); };
    float mean_square = 0;
    for (ElementIndex e = first; e < first + 4; ++e) mean_square += std::pow(rho(e) - rho(parent), 2.0f) / 4;
    return exposure_ * std::sqrt(mean_square) * std::max(0.0f, luminance(light_.solution.irradiance[parent]));
}

float VisibleDifference::threshold(ElementIndex leaf) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Rgb rho = inputs_.materials.surface(light_.forest->patch(leaf), leaf).reflectance;
    const float shown = exposure_ * luminance(rho);  // display luminance per irradiance
    if (!(light_.solution.view_importance[leaf] > 0 && shown > 0)) return infinity;
    const float pixels = light_.forest->area(leaf) / pixel_area(inputs_, light_, leaf);
    const float period = std::sqrt(std::max(1.0f, pixels));  // extent of two adjacent children [pixels]
    const float unmasked = jnd_of_edge * cone_threshold(adapted_luminance(leaf, pixels)) /
                           relative_sensitivity(static_cast<double>(pixels_per_degree / period));
    const float visible = unmasked * threshold_elevation(masking_contrast(leaf) / unmasked);
    return std::pow(visible / shown, 2.0f);
}

}  // namespace interflect::detail
