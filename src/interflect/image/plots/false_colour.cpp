#include "interflect/plots.h"

#include <algorithm>
#include <cmath>

namespace interflect {

namespace {

constexpr double ignored_value_share = 0.005;  // outside a logarithmic scale at each end
constexpr float max_ratio = 1e6f;              // ratio of the ends of a logarithmic scale

/// Oklab [Ottosson 2020] to linear Rec. 709.
Rgb rgb_of_oklab(const V3f& lab) {
    const auto cube = [](float x) { return x * x * x; };
    const float l = cube(lab.x + 0.3963377774f * lab.y + 0.2158037573f * lab.z);
    const float m = cube(lab.x - 0.1055613458f * lab.y - 0.0638541728f * lab.z);
    const float s = cube(lab.x - 0.0894841775f * lab.y - 1.2914855480f * lab.z);
    return {4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
            -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
            -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
}

}  // namespace

Rgb false_colour(float position) {
    // Longest parabola in Oklab inside Rec. 709 whose speed varies by at most a quarter.
    constexpr V3f violet(0.27f, 0.101f, -0.078f), teal(0.595f, -0.212f, -0.097f), yellow(0.92f, -0.075f, 0.189f);
    const float t = std::clamp(position, 0.0f, 1.0f), u = 1 - t;
    const Rgb colour = rgb_of_oklab(u * u * violet + 2 * t * u * teal + t * t * yellow);
    return {std::max(colour.x, 0.0f), std::max(colour.y, 0.0f), std::max(colour.z, 0.0f)};
}

float ColourScale::position(float value) const {
    const float t = spacing == Spacing::linear ? (value - low) / (high - low)
                                               : std::log(std::max(value, low) / low) / std::log(high / low);
    return std::clamp(t, 0.0f, 1.0f);
}

ColourScale fit_scale(std::vector<float> values, Spacing spacing) {
    const bool logarithmic = spacing == Spacing::logarithmic;
    std::erase_if(values, [&](float v) { return !std::isfinite(v) || (logarithmic && v <= 0); });
    if (values.empty()) return {logarithmic ? 0.1f : 0.0f, 1, spacing};
    std::sort(values.begin(), values.end());
    if (!logarithmic) return {std::min(0.0f, values.front()), values.back() > 0 ? values.back() : 1, spacing};
    const auto ignored = static_cast<std::size_t>(ignored_value_share * static_cast<double>(values.size()));
    const float high = values[values.size() - 1 - ignored], low = std::max(values[ignored], high / max_ratio);
    return low < high ? ColourScale{low, high, spacing} : ColourScale{high / 10, high, spacing};
}

ColourScale fit_round_scale(std::vector<float> values) {
    std::erase_if(values, [](float v) { return !(std::isfinite(v) && v > 0); });
    if (values.empty()) return {};
    constexpr double exceeding_share = 0.02;
    const auto exceeding = static_cast<std::ptrdiff_t>(exceeding_share * static_cast<double>(values.size()));
    const auto highest = values.end() - 1 - exceeding;
    std::nth_element(values.begin(), highest, values.end());
    const float power = std::pow(10.0f, std::floor(std::log10(*highest)));
    constexpr float rounding = 1.0001f;
    for (const float factor : {1.0f, 1.5f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 8.0f})
        if (*highest <= rounding * factor * power) return {0, factor * power, Spacing::linear};
    return {0, 10 * power, Spacing::linear};
}

Image false_colours(const Image& values, const ColourScale& scale) {
    Image image = values;
    for (Rgb& pixel : image.pixels)
        if (std::isfinite(pixel.x) && pixel.x != 0) pixel = false_colour(scale.position(pixel.x));
    return image;
}

}  // namespace interflect
