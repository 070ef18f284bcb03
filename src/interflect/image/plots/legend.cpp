#include "interflect/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/image/plots/lettering.h"

namespace interflect {

using namespace detail;

namespace {

/// Offsets from the top of the legend [dots]; a dot is a square of pixels that is the unit of the lettering.
constexpr int margin = 6, title_top = 5, strip_top = 17, strip_bottom = 27, tick_bottom = 30, numbers_top = 32,
              legend_bottom = 43;
constexpr int min_values = 3;
/// Room for a number, and minimum gap between numbers [dots].
constexpr int number_width = 64, number_gap = 8;

void require_valid(const ColourScale& scale) {
    const bool positive = scale.spacing == Spacing::linear || scale.low > 0;
    if (!(scale.low < scale.high && std::isfinite(scale.high - scale.low) && positive))
        throw InputError(fmt::format("a scale of colours from {} to {}: expected rising ends, above 0 if logarithmic",
                                     scale.low, scale.high));
}

void require_printable(const std::string& title) {
    if (!std::all_of(title.begin(), title.end(), [](char c) { return c >= ' ' && c <= '~'; }))
        throw InputError("the title of a legend '" + title + "': expected printable ASCII");
}

double round_below(double x) {
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= x) return factor * power;
    return power;
}

constexpr double rounding = 1e-5;  // relative tolerance

std::vector<float> multiples(const ColourScale& scale, double step) {
    std::vector<float> values;
    for (double k = std::ceil(scale.low / step - rounding) + 0.0; k <= scale.high / step + rounding; ++k)
        values.push_back(static_cast<float>(k * step));
    return values;
}

std::vector<float> multiples_of_powers(const ColourScale& scale, const std::vector<double>& factors, int stride) {
    std::vector<float> values;
    const double low = scale.low * (1 - rounding), high = scale.high * (1 + rounding);
    const int first = static_cast<int>(std::floor(std::log10(low) / stride)) * stride;
    for (int exponent = first; std::pow(10, exponent) <= high; exponent += stride)
        for (const double factor : factors)
            if (const double value = factor * std::pow(10, exponent); value >= low && value <= high)
                values.push_back(static_cast<float>(value));
    return values;
}

/// Returns the length of the coloured strip [pixels].
int strip_length(const Image& image, int dot) { return std::max(1, image.width - 2 * margin * dot); }

void draw_strip(Image& image, int top, int dot) {
    const int left = margin * dot, length = strip_length(image, dot);
    for (int x = 0; x < length; ++x)
        fill(image, left + x, top + strip_top * dot, left + x + 1, top + strip_bottom * dot,
             false_colour((static_cast<float>(x) + 0.5f) / static_cast<float>(length)));
}

void draw_numbers(Image& image, int top, int dot, const ColourScale& scale) {
    const int left = margin * dot, length = strip_length(image, dot);
    int free_from = left;
    for (const float value : round_values(scale, std::max(min_values, length / (number_width * dot)))) {
        const int x = left + static_cast<int>(scale.position(value) * static_cast<float>(length - dot));
        fill(image, x, top + strip_bottom * dot, x + dot, top + tick_bottom * dot, ink);
        const std::string number = fmt::format("{:.6g}", value);
        const int width = text_width(number, dot),
                  begin = std::clamp(x - width / 2, left, left + std::max(0, length - width));
        if (begin < free_from) continue;
        write_text(image, begin, top + numbers_top * dot, number, dot);
        free_from = begin + width + number_gap * dot;
    }
}

}  // namespace

std::vector<float> round_values(const ColourScale& scale, int most) {
    require_valid(scale);
    if (most < min_values) throw InputError(fmt::format("{} round values: expected 3 or more", most));
    const auto are_few = [&](const std::vector<float>& values) { return static_cast<int>(values.size()) <= most; };
    if (scale.spacing == Spacing::logarithmic && scale.high >= 10 * scale.low) {
        std::vector<float> values = multiples_of_powers(scale, {1, 2, 5}, 1);
        for (int stride = 1; !are_few(values); ++stride) values = multiples_of_powers(scale, {1}, stride);
        return values;
    }
    constexpr double finer = 0.6;  // factor after which round_below() gives the next step: 5 to 2, 2 to 1, 1 to 0.5
    double step = round_below(scale.high - scale.low);
    while (are_few(multiples(scale, round_below(finer * step)))) step = round_below(finer * step);
    return multiples(scale, step);
}

int legend_height(int width) { return legend_bottom * dot_size(width); }

bool legend_fits(int width, int height, const std::string& title) {
    require_printable(title);
    const int dot = dot_size(width), room = width - 2 * margin * dot;
    return room >= text_width(title, dot) && room >= min_values * number_width * dot &&
           legend_height(width) <= height / 2;
}

Image with_legend(const Image& picture, const ColourScale& scale, const std::string& title) {
    require_printable(title);
    require_valid(scale);
    const int top = picture.height, dot = dot_size(picture.width);
    const std::int64_t height = std::int64_t{top} + legend_height(picture.width);
    if (picture.width > max_image_pixels / height)
        throw InputError(fmt::format("a picture of {} x {} pixels with its legend: expected at most {} pixels in all",
                                     picture.width, height, max_image_pixels));
    require_pixels(picture);
    Image image(picture.width, static_cast<int>(height), paper);
    std::copy(picture.pixels.begin(), picture.pixels.end(), image.pixels.begin());

    write_text(image, margin * dot, top + title_top * dot, title, dot);
    draw_strip(image, top, dot);
    draw_numbers(image, top, dot, scale);
    return image;
}

}  // namespace interflect
