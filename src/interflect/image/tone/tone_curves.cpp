#include "interflect/image/tone/tone_curves.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

constexpr float reinhard_white = 4.0f;

constexpr float filmic_scale = 0.72317f;

float narkowicz(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

/// Mid grey, and the range of the logarithm around it [stops].
constexpr float mid_grey = 0.18f, stops_below = 10, stops_above = 6.5f;
/// `contrast` is the slope at (pivot_in, pivot_out); the powers bend the ends to 0 and 1.
constexpr float pivot_in = stops_below / (stops_below + stops_above), pivot_out = 0.5f, contrast = 2, toe_power = 3,
                shoulder_power = 3.25f;
constexpr float display_power = 2.2f;

/// Returns half of a sigmoid: from 0 with slope `contrast` to `height` at `width`.
float bend(float x, float width, float height, float power) {
    const float straight = contrast * width;
    const float limit = straight / std::pow(std::pow(straight / height, power) - 1, 1 / power);
    const float t = contrast * x / limit;
    return limit * t / std::pow(1 + std::pow(t, power), 1 / power);
}

float sigmoid(float x) {
    return x < pivot_in ? pivot_out - bend(pivot_in - x, pivot_in, pivot_out, toe_power)
                        : pivot_out + bend(x - pivot_in, 1 - pivot_in, 1 - pivot_out, shoulder_power);
}

float logarithmic(float v) {
    const float stops = std::log2(std::max(v, 1e-10f) / mid_grey);
    return std::clamp((stops + stops_below) / (stops_below + stops_above), 0.0f, 1.0f);
}

}  // namespace

Rgb reinhard_curve(const Rgb& v) {
    const float l = luminance(v);
    return v * ((1 + l / (reinhard_white * reinhard_white)) / (1 + l));
}

Rgb filmic_curve(const Rgb& v) {
    return Rgb(narkowicz(filmic_scale * v.x), narkowicz(filmic_scale * v.y), narkowicz(filmic_scale * v.z));
}

Rgb agx_curve(const Rgb& v) {
    if (v == Rgb(0)) return v;  // avoids rounding errors of the sigmoid
    // Columns sum to 1 to preserve greys.
    static const Imath::M33f inset(0.8424f, 0.0423f, 0.0424f,  //
                                   0.0784f, 0.8785f, 0.0784f,  //
                                   0.0792f, 0.0792f, 0.8792f);
    static const Imath::M33f outset = inset.inverse();
    const V3f wide = V3f(v) * inset;
    const V3f shown =
        V3f(sigmoid(logarithmic(wide.x)), sigmoid(logarithmic(wide.y)), sigmoid(logarithmic(wide.z))) * outset;
    const auto decoded = [](float encoded) { return std::pow(std::max(encoded, 0.0f), display_power); };
    return Rgb(decoded(shown.x), decoded(shown.y), decoded(shown.z));
}

}  // namespace interflect::detail
