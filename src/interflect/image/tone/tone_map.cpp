#include "interflect/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "interflect/core.h"
#include "interflect/image/tone/tone_curves.h"
#include "interflect/image/tone/visual_adaptation.h"

namespace interflect {

using namespace detail;

namespace {

constexpr double key = 0.2;                   // logarithmic mean after exposure; 1 is white
constexpr double ignored_pixel_share = 0.05;  // share of the lit pixels that is ignored at each end

/// Returns the logarithmic mean over the finite pixels with `measure` > 0, or 0 without such pixels.
double logarithmic_mean(const Image& image, float (*measure)(const Rgb&)) {
    std::vector<float> lit;
    lit.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels)
        if (is_finite(pixel) && measure(pixel) > 0) lit.push_back(measure(pixel));
    if (lit.empty()) return 0;
    std::sort(lit.begin(), lit.end());

    const auto ignored = static_cast<std::size_t>(ignored_pixel_share * static_cast<double>(lit.size()));
    const std::size_t counted = lit.size() - 2 * ignored;
    double stops = 0;
    for (std::size_t i = ignored; i < ignored + counted; ++i) stops += std::log2(lit[i]);
    return std::exp2(stops / static_cast<double>(counted));
}

float photopic(const Rgb& colour) { return luminance(colour); }
float scotopic(const Rgb& colour) { return scotopic_luminance(colour); }

using Operator = std::function<Rgb(const Rgb&)>;

/// Maps radiance >= 0 to displayed values, not clipped.
Operator absolute_operator(const Image& image, Tonemap curve, float white) {
    const auto adapted = static_cast<float>(logarithmic_mean(image, photopic));
    if (!(adapted > 0)) return [](const Rgb&) { return Rgb(0); };
    if (curve == Tonemap::ward) return [factor = ward_factor(adapted, white)](const Rgb& v) { return factor * v; };
    if (curve == Tonemap::ferwerda)
        return FerwerdaOperator(adapted, static_cast<float>(logarithmic_mean(image, scotopic)), white);
    return [brightness = TumblinOperator(adapted, white)](const Rgb& v) {
        const float l = luminance(v);
        return l > 0 ? v * (brightness(l) / l) : Rgb(0);
    };
}

Rgb apply_curve(const Rgb& v, Tonemap curve) {
    switch (curve) {
        case Tonemap::reinhard:
            return reinhard_curve(v);
        case Tonemap::filmic:
            return filmic_curve(v);
        case Tonemap::agx:
            return agx_curve(v);
        default:
            return v;
    }
}

Operator tone_operator(const Image& image, float gain, Tonemap curve, float white) {
    if (!is_absolute(curve)) return [gain, curve](const Rgb& v) { return apply_curve(gain * v, curve); };
    return [gain, shown = absolute_operator(image, curve, white)](const Rgb& v) { return gain * shown(v); };
}

}  // namespace

float automatic_exposure(const Image& image) {
    const double mean = logarithmic_mean(image, photopic);
    return mean > 0 ? static_cast<float>(std::log2(key / mean)) : 0;
}

Image tone_map(const Image& image, float exposure, Tonemap curve, float display_luminance) {
    if (!std::isfinite(exposure)) throw InputError(fmt::format("an exposure of {} stops: expected a number", exposure));
    if (!(std::isfinite(display_luminance) && display_luminance > 0))
        throw InputError(fmt::format("a display luminance of {} cd/m^2: expected a number above 0", display_luminance));
    const Operator shown_of = tone_operator(image, std::exp2(exposure), curve, display_luminance);
    Image shown = image;
    for (Rgb& pixel : shown.pixels) {
        if (!is_finite(pixel)) continue;
        const Rgb mapped = shown_of(Rgb(std::max(0.0f, pixel.x), std::max(0.0f, pixel.y), std::max(0.0f, pixel.z)));
        // Turns the NaN of an overflow into white.
        for (int c = 0; c < 3; ++c) pixel[c] = std::min(1.0f, mapped[c]);
    }
    return shown;
}

}  // namespace interflect
