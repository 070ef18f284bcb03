#include "interflect/tone_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "interflect/error.h"

namespace interflect {

namespace {

constexpr double key = 0.28;                  // what the logarithmic mean becomes, 1 being white
constexpr double ignored_pixel_share = 0.05;  // of the lit pixels, at either end

/// Luminance that becomes white under Tonemap::reinhard.
constexpr float reinhard_white = 4.0f;

/// Input of Hable's curve for an exposed value of 1: with it 0.18 stays 0.18.
constexpr float filmic_scale = 1.76f;
/// Input that becomes white [Hable 2010].
constexpr float filmic_white = 11.2f;

/// Hable, 'Filmic tonemapping for real-time rendering' (SIGGRAPH 2010 course), with the constants given there: a
/// rational fit of a film's response with a linear part, a short toe and a long shoulder. His (x (a x + c b) + d e) /
/// (x (a x + b) + d f) - e / f stands here as one fraction, so that 0 gives 0 exactly.
float hable(float x) {
    constexpr float a = 0.22f, b = 0.30f, c = 0.10f, d = 0.20f, e = 0.01f, f = 0.30f;
    return x * (a * (f - e) * x + b * (c * f - e)) / (f * (x * (a * x + b) + d * f));
}

float filmic(float v) {
    static const float white = hable(filmic_white);
    return hable(filmic_scale * std::min(v, filmic_white)) / white;
}

/// Luminance out over luminance in. // Eq. 4, Reinhard et al. 2002
float reinhard_gain(float luminance) { return (1 + luminance / (reinhard_white * reinhard_white)) / (1 + luminance); }

Rgb apply_curve(const Rgb& v, Tonemap curve) {
    switch (curve) {
        case Tonemap::reinhard:
            return v * reinhard_gain(luminance(v));
        case Tonemap::filmic:
            return Rgb(filmic(v.x), filmic(v.y), filmic(v.z));
        case Tonemap::linear:
            break;
    }
    return v;
}

}  // namespace

float automatic_exposure(const Image& image) {
    std::vector<float> lit;
    for (const Rgb& pixel : image.pixels)
        if (is_finite(pixel) && luminance(pixel) > 0) lit.push_back(luminance(pixel));
    if (lit.empty()) return 0;
    std::sort(lit.begin(), lit.end());

    const auto ignored = static_cast<std::size_t>(ignored_pixel_share * static_cast<double>(lit.size()));
    const std::size_t counted = lit.size() - 2 * ignored;
    double stops = 0;
    for (std::size_t i = ignored; i < ignored + counted; ++i) stops += std::log2(lit[i]);
    return static_cast<float>(std::log2(key) - stops / static_cast<double>(counted));
}

Image tone_map(const Image& image, float exposure, Tonemap curve) {
    if (!std::isfinite(exposure)) throw InputError(fmt::format("an exposure of {} stops: expected a number", exposure));
    const float gain = std::exp2(exposure);
    Image shown = image;
    for (Rgb& pixel : shown.pixels) {
        if (!is_finite(pixel)) continue;
        const Rgb exposed(std::max(0.0f, gain * pixel.x), std::max(0.0f, gain * pixel.y),
                          std::max(0.0f, gain * pixel.z));
        const Rgb mapped = apply_curve(exposed, curve);
        for (int c = 0; c < 3; ++c) pixel[c] = std::min(mapped[c], 1.0f);
    }
    return shown;
}

}  // namespace interflect
