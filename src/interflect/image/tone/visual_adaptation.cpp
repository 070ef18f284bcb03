#include "interflect/image/tone/visual_adaptation.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

/// C_max of Tumblin et al. 1999, who give 30 to 100.
constexpr float display_contrast = 100;

/// gamma of Tumblin et al. 1999.
float brightness_exponent(float adapted) {
    return adapted > 100 ? 2.655f : 1.855f + 0.4f * std::log10(adapted + 2.3e-5f);
}

/// Weight k of the rods in Ferwerda et al., by the parabola of Durand and Dorsey 2000.
float rod_share(float adapted) {
    constexpr float darkest = 0.01f, brightest = 10;  // of the mesopic range [cd/m^2]
    const float k = std::clamp(1 - (adapted / 2 - darkest) / (brightest - darkest), 0.0f, 1.0f);
    return k * k;
}

}  // namespace

float ward_factor(float adapted, float white) {
    const auto visible = [](float luminance) { return 1.219f + std::pow(luminance, 0.4f); };  // Blackwell's data
    return std::pow(visible(white / 2) / visible(adapted), 2.5f) / white;
}

TumblinOperator::TumblinOperator(float adapted, float white) : adapted_(adapted) {
    const float middle = white / std::sqrt(display_contrast);
    exponent_ = brightness_exponent(adapted) / brightness_exponent(middle);
    // Tumblin's factor m, which darkens dim scenes.
    scale_ = std::pow(std::sqrt(display_contrast), exponent_ - 1) * middle / white;
}

float TumblinOperator::operator()(float luminance) const { return scale_ * std::pow(luminance / adapted_, exponent_); }

FerwerdaOperator::FerwerdaOperator(float adapted, float rods_adapted, float white) {
    const float display_threshold = cone_threshold(white / 2) / white;
    cones_ = display_threshold / cone_threshold(adapted);
    rods_ = rod_share(adapted) * display_threshold / rod_threshold(rods_adapted);
}

Rgb FerwerdaOperator::operator()(const Rgb& radiance) const {
    return cones_ * radiance + Rgb(rods_ * scotopic_luminance(radiance));
}

float cone_threshold(float adapted) {
    const float x = std::log10(adapted);
    const float y = x <= -2.6f ? -0.72f : x >= 1.9f ? x - 1.255f : std::pow(0.249f * x + 0.65f, 2.7f) - 0.72f;
    return std::pow(10.0f, y);
}

float rod_threshold(float adapted) {
    const float x = std::log10(adapted);
    const float y = x <= -3.94f ? -2.86f : x >= -1.44f ? x - 0.395f : std::pow(0.405f * x + 1.6f, 2.18f) - 2.86f;
    return std::pow(10.0f, y);
}

double contrast_sensitivity(double cycles_per_degree) {
    const double f = 0.114 * cycles_per_degree;
    return 2.6 * (0.0192 + f) * std::exp(-std::pow(f, 1.1));
}

}  // namespace interflect::detail
